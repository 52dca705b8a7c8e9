// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/episodes.hpp"

#include <cmath>
#include <map>
#include <mutex>
#include <optional>

#include <fmt/format.h>

#include "core/base/random.hpp"
#include "sim/lab/parallel.hpp"

namespace headland {
namespace {

constexpr const char* kEpisodes = "episodes.csv";
constexpr const char* kTimes = "times.csv";

double two_digits(double value) {
  if (!(value > 0.0) || !std::isfinite(value)) return 0.0;
  return std::stod(fmt::format("{:.1e}", value));
}

// Times as rows: how long, and how often.
EpisodeRows counted(const std::vector<double>& times) {
  std::map<double, int> counts;
  for (const double time : times) ++counts[two_digits(time)];
  EpisodeRows rows;
  for (const auto& [time, count] : counts) rows.push_back({time, static_cast<double>(count)});
  if (rows.empty()) rows.push_back({0.0, 0.0});
  return rows;
}

std::vector<double> uncounted(const EpisodeRows& rows) {
  std::vector<double> times;
  for (const auto& row : rows) times.insert(times.end(), static_cast<std::size_t>(row[1]), row[0]);
  return times;
}

// The episodes that are done, in memory and, if there is a folder, in its files.
class Ledger {
 public:
  Ledger(const EpisodeGrid& grid, const std::filesystem::path& folder) : grid_(grid) {
    if (folder.empty()) return;
    std::string all = grid.study + "\n" + grid.config_yaml;
    for (const std::string& column : grid.columns) all += "\n" + column;
    const std::uint64_t hash = fnv1a(all);
    rows_log_.emplace(folder / kEpisodes, grid.study, hash, grid.columns, grid.cells);
    times_log_.emplace(folder / kTimes, grid.study, hash,
                       std::vector<std::string>{"plan_ms", "plans_count"}, grid.cells);
    file_ = (folder / kEpisodes).string();
  }

  // Takes up what an earlier run left.
  Result<void> open() {
    if (!rows_log_) return {};
    auto rows = rows_log_->read();
    if (!rows) return tl::unexpected<Error>(rows.error());
    auto times = times_log_->read();
    if (!times) return tl::unexpected<Error>(times.error());
    for (auto& [key, its_rows] : *rows) {
      const auto its_times = times->find(key);
      if (its_times == times->end()) continue;
      if (key.run >= grid_.runs_count) return too_many(key.run + 1);
      rows_.emplace(key, std::move(its_rows));
      times_.emplace(key, std::move(its_times->second));
    }
    return write();
  }

  bool has(const EpisodeKey& key) const { return rows_.contains(key); }
  std::size_t size() const { return rows_.size(); }

  Result<void> add(const EpisodeKey& key, Episode episode) {
    const EpisodeRows& rows = rows_.emplace(key, std::move(episode.rows)).first->second;
    const EpisodeRows& times = times_.emplace(key, counted(episode.plan_ms)).first->second;
    if (!rows_log_) return {};
    if (auto kept = rows_log_->append(key, rows); !kept) return kept;
    return times_log_->append(key, times);
  }

  // The files, in order.
  Result<void> write() const {
    if (!rows_log_) return {};
    if (auto written = rows_log_->write(rows_); !written) return written;
    return times_log_->write(times_);
  }

  Error stopped(std::size_t count) const {
    return {ErrorCode::kStopped,
            fmt::format("stopped with {} of {} episodes", size(), count),
            rows_log_ ? "the same command goes on from there" : "",
            {file_, 0, ""}};
  }

  std::vector<std::vector<Episode>> take() {
    std::vector<std::vector<Episode>> episodes(grid_.cells.size());
    for (auto& [key, rows] : rows_) {
      episodes[static_cast<std::size_t>(key.cell)].push_back(
          {std::move(rows), uncounted(times_[key])});
    }
    return episodes;
  }

 private:
  tl::unexpected<Error> too_many(int runs) const {
    return fail(
        ErrorCode::kFileNotWritable,
        fmt::format("holds {} runs of a cell or more, {} are asked for", runs, grid_.runs_count),
        "choose another directory with --out, or more runs", {file_, 0, ""});
  }

  const EpisodeGrid& grid_;
  std::optional<EpisodeLog> rows_log_;
  std::optional<EpisodeLog> times_log_;
  std::string file_;
  std::map<EpisodeKey, EpisodeRows> rows_;
  std::map<EpisodeKey, EpisodeRows> times_;
};

}  // namespace

Result<std::vector<std::vector<Episode>>> run_episodes(
    const EpisodeGrid& grid, const StudyRun& run,
    const std::function<Episode(int cell, int run)>& work) {
  Ledger ledger(grid, run.out);
  if (auto opened = ledger.open(); !opened) return tl::unexpected<Error>(opened.error());
  // All cells of a run before the next run, so that what there is can be compared at any time.
  std::vector<EpisodeKey> due;
  for (int r = 0; r < grid.runs_count; ++r) {
    for (int c = 0; c < static_cast<int>(grid.cells.size()); ++c) {
      if (!ledger.has({c, r})) due.push_back({c, r});
    }
  }
  const std::size_t count = ledger.size() + due.size();
  std::mutex mutex;  // of the ledger, what went wrong, and the callbacks
  Result<void> kept;
  const auto over = [&] {
    const std::lock_guard lock(mutex);
    return !kept || (run.stopped && run.stopped());
  };
  parallel_for(static_cast<int>(due.size()), run.jobs, [&](int i) {
    if (over()) return;
    const EpisodeKey key = due[static_cast<std::size_t>(i)];
    Episode episode = work(key.cell, key.run);
    const std::lock_guard lock(mutex);
    if (auto added = ledger.add(key, std::move(episode)); !added) kept = added;
    if (run.progress) {
      run.progress(static_cast<double>(ledger.size()) / static_cast<double>(count));
    }
  });
  if (!kept) return tl::unexpected<Error>(kept.error());
  if (ledger.size() < count) return tl::unexpected<Error>(ledger.stopped(count));
  if (auto written = ledger.write(); !written) return tl::unexpected<Error>(written.error());
  return ledger.take();
}

std::vector<std::string> episode_files() { return {kEpisodes, kTimes}; }

}  // namespace headland
