// SPDX-License-Identifier: Apache-2.0
// Orienteering in the format of Tsiligirides and Chao: `budget paths`, then a line `x y score` for
// each point, the start first and the finish second. Team orienteering heads its points by three
// lines `n`, `m` (paths) and `tmax`, and its finish is the last.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "global_planner/tour/internal/instance_text.hpp"

namespace headland::tour {
namespace {

// Of the least difference in score that all ways of all paths together may make up for.
constexpr double kTieShare = 0.01;

struct Points {
  std::vector<Point> at;
  std::vector<double> scores;
};

Points read_points(InstanceText& text, std::size_t first_line) {
  Points points;
  for (std::size_t i = first_line; i < text.lines().size() && text.ok(); ++i) {
    const auto& words = text.lines()[i];
    if (words.size() != 3) {
      text.wrong(ErrorCode::kSyntax, words.front().line,
                 fmt::format("{} words where a point stands", words.size()), "allowed: x y score");
      break;
    }
    points.at.push_back(
        {text.number(words[0], "coordinate", -1e9), text.number(words[1], "coordinate", -1e9)});
    points.scores.push_back(text.number(words[2], "score", 0.0));
  }
  return points;
}

}  // namespace

void set_orienteering(RouteInstance& instance, const std::function<double(int, int)>& length,
                      const std::vector<double>& scores, int finish, double budget, int paths) {
  instance.format = "OP";
  instance.objective = RouteObjective::kScore;
  instance.whole_costs = std::all_of(scores.begin(), scores.end(),
                                     [](double score) { return score == std::floor(score); });
  const double unit = instance.whole_costs ? 1.0 : 1e-6;
  instance.tie_break = kTieShare * unit / std::max(1e-9, budget * paths);
  set_ways(instance.problem, length, instance.tie_break, 1.0, 0.0);
  for (int site = 0; site < instance.problem.sites; ++site) {
    if (site == 0 || site == finish) continue;
    add_place(instance, site, std::to_string(site + 1), 0.0).reward =
        scores[static_cast<std::size_t>(site)];
  }
  instance.start_name = '1';
  instance.finish_name = std::to_string(finish + 1);
  TourVehicle vehicle;
  vehicle.finish = finish;
  vehicle.latest_s = budget;
  instance.problem.vehicles.assign(static_cast<std::size_t>(paths), vehicle);
}

RouteInstance read_orienteering(InstanceText& text) {
  RouteInstance instance;
  const auto& lines = text.lines();
  const bool team = lines.front().front().text == "n";
  const std::size_t head = team ? 3 : 1;
  const bool shaped = std::all_of(
      lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(std::min(head, lines.size())),
      [](const auto& words) { return words.size() == 2; });
  if (lines.size() < head + 2 || !shaped) {
    text.wrong(
        ErrorCode::kSyntax, shaped ? text.last_line() : 1, "not an orienteering instance",
        team ? "allowed: lines 'n <points>', 'm <paths>', 'tmax <length>', then x y score"
             : "allowed: a line 'budget paths', then lines 'x y score', start and finish first");
    return instance;
  }
  const int paths = text.whole(team ? lines[1][1] : lines[0][1], "number of paths", 1, 100);
  const double budget = text.number(team ? lines[2][1] : lines[0][0], "budget", 0.0);
  const Points points = read_points(text, head);
  const int count = static_cast<int>(points.at.size());
  if (team && text.ok() && text.whole(lines[0][1], "number of points", 2, kMaxNodes) != count) {
    text.wrong(ErrorCode::kSyntax, lines[0][1].line,
               fmt::format("{} points announced, {} given", lines[0][1].text, count),
               "give as many lines 'x y score'");
  }
  if (count > kMaxNodes) {
    text.wrong(ErrorCode::kOutOfRange, text.last_line(), fmt::format("{} points", count),
               fmt::format("allowed: 2 to {}", kMaxNodes));
  }
  if (!text.ok()) return instance;
  instance.problem.sites = count;
  const auto length = [&](int a, int b) {
    return euclidean(points.at[static_cast<std::size_t>(a)],
                     points.at[static_cast<std::size_t>(b)]);
  };
  set_orienteering(instance, length, points.scores, team ? count - 1 : 1, budget, paths);
  return instance;
}

}  // namespace headland::tour
