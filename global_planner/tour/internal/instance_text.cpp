// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/internal/instance_text.hpp"

#include <charconv>
#include <cmath>

#include <fmt/format.h>

namespace headland::tour {
namespace {

constexpr std::string_view kBlank = " \t\r\f\v";

// Of a word that may be long, or not text at all.
std::string quoted(std::string_view word) {
  std::string shown;
  for (const char c : word.substr(0, 40)) shown += c >= ' ' && c <= '~' ? c : '?';
  return "'" + shown + (word.size() > 40 ? "...'" : "'");
}

}  // namespace

InstanceText::InstanceText(std::string file, const std::string& text)
    : file_(std::move(file)), text_(text) {
  const std::string_view all = text_;
  for (std::size_t begin = 0; begin < all.size();) {
    const std::size_t end = std::min(all.find('\n', begin), all.size());
    raw_.push_back(all.substr(begin, end - begin));
    begin = end + 1;
    std::vector<Word> words;
    const std::string_view line = raw_.back();
    for (std::size_t at = line.find_first_not_of(kBlank); at < line.size();) {
      const std::size_t stop = std::min(line.find_first_of(kBlank, at), line.size());
      words.push_back({line.substr(at, stop - at), last_line()});
      at = line.find_first_not_of(kBlank, stop);
    }
    if (!words.empty()) lines_.push_back(std::move(words));
  }
}

std::string_view InstanceText::line_text(int line) const {
  const std::string_view raw = raw_[static_cast<std::size_t>(line - 1)];
  const std::size_t first = raw.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return raw.substr(first, raw.find_last_not_of(kBlank) - first + 1);
}

std::string InstanceText::stem() const { return std::filesystem::path(file_).stem().string(); }

double InstanceText::number(const Word& word, std::string_view what, double least) {
  double value = 0.0;
  std::string_view digits = word.text;
  if (digits.size() > 1 && digits.front() == '+') digits.remove_prefix(1);
  const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool read = code == std::errc() && end == digits.data() + digits.size();
  constexpr double kMost = 1e15;  // beyond, sums lose whole units
  if (!read || !(value >= least && value <= kMost)) {
    wrong(
        read ? ErrorCode::kOutOfRange : ErrorCode::kWrongType, word.line,
        fmt::format("{} {} is {}", what, quoted(word.text), read ? "out of range" : "not a number"),
        least > -kMost ? fmt::format("allowed: a number, {} or more", least)
                       : "allowed: a finite number");
    return 0.0;
  }
  return value;
}

int InstanceText::whole(const Word& word, std::string_view what, int least, int most) {
  const double value = number(word, what, -1e15);
  if (!ok()) return least;
  if (value != std::floor(value) || value < least || value > most) {
    wrong(ErrorCode::kOutOfRange, word.line,
          fmt::format("{} {} is out of range", what, quoted(word.text)),
          fmt::format("allowed: a whole number, {} to {}", least, most));
    return least;
  }
  return static_cast<int>(value);
}

void InstanceText::wrong(ErrorCode code, int line, std::string what, std::string remedy) {
  if (!error_) error_ = Error{code, std::move(what), std::move(remedy), {file_, line, ""}};
}

double euclidean(const Point& a, const Point& b) { return std::hypot(a.x - b.x, a.y - b.y); }

void set_ways(TourProblem& problem, const std::function<double(int, int)>& length,
              double cost_per_unit, double duration_per_unit, double energy_per_unit) {
  TourProfile& profile = problem.profiles.emplace_back();
  const auto sites = static_cast<std::size_t>(problem.sites);
  profile.ways.resize(sites * sites);
  for (int from = 0; from < problem.sites; ++from) {
    for (int to = 0; to < problem.sites; ++to) {
      if (from == to) continue;
      const double l = length(from, to);
      profile.ways[static_cast<std::size_t>(from) * sites + static_cast<std::size_t>(to)] = {
          l * cost_per_unit, l * duration_per_unit, l * energy_per_unit, l * energy_per_unit};
    }
  }
}

TourTask& add_place(RouteInstance& instance, int site, std::string name, double service_s) {
  TourLeg work;
  work.duration_s = service_s;
  instance.problem.profiles.front().work.push_back({work});
  instance.task_names.push_back(std::move(name));
  TourTask& task = instance.problem.tasks.emplace_back();
  task.modes = {{site, site}};
  return task;
}

}  // namespace headland::tour
