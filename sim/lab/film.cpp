// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/film.hpp"

#include <algorithm>
#include <optional>

#include "local_planner/outline.hpp"

namespace headland {
namespace {

using Episodes = std::vector<std::vector<Episode>>;

// All cells of a run before the next run; only those of the planner.
std::optional<EpisodeKey> first_of(const Episodes& episodes,
                                   const std::vector<std::string>& planners,
                                   const std::string& planner,
                                   const std::function<bool(const EpisodeKey&)>& holds) {
  std::size_t runs = 0;
  for (const auto& cell : episodes) runs = std::max(runs, cell.size());
  for (std::size_t run = 0; run < runs; ++run) {
    for (std::size_t cell = 0; cell < episodes.size(); ++cell) {
      if (planners[cell] != planner || run >= episodes[cell].size()) continue;
      const EpisodeKey key{static_cast<int>(cell), static_cast<int>(run)};
      if (holds(key)) return key;
    }
  }
  return std::nullopt;
}

}  // namespace

double outline_gap(const Footprint& outline, const Pose2& pose, const Point2& agent,
                   double radius) {
  return outline_distance(outline, inverse(pose) * agent) - radius;
}

std::vector<FilmChoice> choose_films(const Episodes& episodes,
                                     const std::vector<std::string>& planners,
                                     const std::vector<FilmReason>& reasons, int count) {
  std::vector<std::string> each;
  for (const std::string& planner : planners) {
    if (std::find(each.begin(), each.end(), planner) == each.end()) each.push_back(planner);
  }
  std::vector<FilmChoice> chosen;
  if (count <= 0 || each.empty()) return chosen;
  const auto share = std::max<std::size_t>(1, static_cast<std::size_t>(count) / each.size());
  for (const std::string& planner : each) {
    const std::size_t before = chosen.size();
    const auto known = [&](const EpisodeKey& key) {
      return std::any_of(chosen.begin(), chosen.end(), [&](const auto& c) { return c.key == key; });
    };
    for (const FilmReason& reason : reasons) {
      if (chosen.size() - before == share) break;
      const auto found = first_of(episodes, planners, planner, [&](const EpisodeKey& key) {
        return reason.holds(episodes[static_cast<std::size_t>(key.cell)]
                                    [static_cast<std::size_t>(key.run)]) &&
               !known(key);
      });
      if (found) chosen.push_back({*found, reason.what});
    }
    if (chosen.size() > before) continue;
    const auto any = first_of(episodes, planners, planner, [](const EpisodeKey&) { return true; });
    if (any) chosen.push_back({*any, "the first"});
  }
  return chosen;
}

}  // namespace headland
