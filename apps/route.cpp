// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iterator>

#include <fmt/format.h>

#include "apps/command.hpp"
#include "apps/interrupt.hpp"
#include "apps/output_files.hpp"
#include "apps/route_output.hpp"
#include "global_planner/tour/tour_solver.hpp"

namespace headland::apps {
namespace {

using Clock = std::chrono::steady_clock;

// Searches from other seeds, one after the other, that find nothing better before it is enough.
constexpr int kVainSearches = 3;

class TimedSearch {
 public:
  TimedSearch(const RouteInstance& instance, const RouteOptions& options)
      : instance_(instance), options_(options), bar_("searching"), begin_(Clock::now()) {}

  double seconds() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }

  Result<TourSolution> run() {
    const InterruptGuard guard;
    auto best = solve(options_.seed);
    if (options_.iterations > 0 || unlimited()) return best;
    for (int vain = 0, k = 1; best && !best->optimal && vain < kVainSearches && !over(); ++k) {
      const auto other = solve(options_.seed + static_cast<std::uint64_t>(k));
      const double bound = std::max(best->lower_bound, other ? other->lower_bound : -kNever);
      ++vain;
      if (other && other->cost < best->cost) {
        best = other;
        vain = 0;
      }
      best->lower_bound = std::min(bound, best->cost);
    }
    return best;
  }

 private:
  // One vehicle and nothing else to mind: the search for an order does not gain from another seed.
  bool unlimited() const { return instance_.format == "ATSP" || instance_.format == "TSP"; }
  bool over() const { return InterruptGuard::interrupted() || seconds() > options_.time_limit_s; }

  Result<TourSolution> solve(std::uint64_t seed) {
    TourOptions options;
    options.seed = seed;
    options.iterations = options_.iterations;
    options.stop = [this] {
      show();
      return over();
    };
    options.progress = [this](double, double cost) { least_ = std::min(least_, cost); };
    return solve_tour(instance_.problem, options);
  }

  void show() {
    constexpr double kPeriod = 0.1;
    if (seconds() < shown_s_ + kPeriod) return;
    shown_s_ = seconds();
    bar_.update(std::min(1.0, shown_s_ / options_.time_limit_s),
                least_ < kNever ? fmt::format("best {:.7g}", least_) : "");
  }

  const RouteInstance& instance_;
  const RouteOptions& options_;
  ProgressBar bar_;
  Clock::time_point begin_;
  double least_ = kNever;
  double shown_s_ = 0.0;
};

// The solver counts tasks; the user knows them by the file's ids.
Error in_its_names(Error error, const RouteInstance& instance, const std::string& file) {
  int task = -1;
  int length = 0;
  if (std::sscanf(error.what.c_str(), "task %d%n", &task, &length) == 1 && task >= 0 &&
      task < std::ssize(instance.task_names)) {
    error.what.replace(0, static_cast<std::size_t>(length),
                       instance.task_names[static_cast<std::size_t>(task)]);
  }
  error.where.file = file;
  return error;
}

Error internal_error(const std::string& wrong) {
  return {ErrorCode::kInternal,
          "the answer found does not stand its check: " + wrong,
          "please report this with the instance",
          {}};
}

std::string settings(const CommonOptions& common, const RouteOptions& options) {
  return fmt::format("file: {}\nseed: {}\niterations_count: {}\ntime_limit_s: {}\n", common.file,
                     options.seed, options.iterations, options.time_limit_s);
}

}  // namespace

int route_command(const CommonOptions& common, const RouteOptions& options) {
  if (!std::isfinite(options.time_limit_s)) {
    return report_error(
        {ErrorCode::kOutOfRange, "not a number", "write a time above 0", {"--time-limit-s", 0, ""}},
        common);
  }
  const auto instance = load_instance(common.file);
  if (!instance) return report_error(instance.error(), common);
  if (!common.out.empty()) {
    if (auto ready = prepare_output(common.out); !ready) {
      return report_error(ready.error(), common);
    }
  }
  TimedSearch search(*instance, options);
  const auto solution = search.run();
  if (!solution) {
    return report_error(in_its_names(solution.error(), *instance, common.file), common);
  }
  if (const auto wrong = check_solution(instance->problem, *solution)) {
    return report_error(internal_error(*wrong), common);
  }
  const RouteAnswer answer = route_answer(*instance, *solution, search.seconds());
  const std::string json =
      route_json(*instance, answer, make_stamp(options.seed, settings(common, options)));
  if (!common.out.empty()) {
    const auto written =
        write_files(common.out, {{"solution.json", json}, {"solution.sol", route_sol(answer)}});
    if (!written) return report_error(written.error(), common);
  }
  fmt::print("{}", common.json ? json : route_text(*instance, answer));
  return 0;
}

}  // namespace headland::apps
