// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/internal/least_legs.hpp"

#include <algorithm>
#include <set>

namespace headland::tour {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// Sites of stations where some vehicle of a profile can charge.
std::vector<std::size_t> station_sites(const TourProblem& problem, int profile) {
  std::set<std::size_t> sites;
  for (const TourVehicle& vehicle : problem.vehicles) {
    if (vehicle.profile != profile) continue;
    for (std::size_t s = 0; s < vehicle.charging.size(); ++s) {
      if (!vehicle.charging[s].points.empty()) sites.insert(at(problem.stations[s].site));
    }
  }
  return {sites.begin(), sites.end()};
}

}  // namespace

LeastLegs::LeastLegs(const TourProblem& problem, const std::function<double(const TourLeg&)>& value)
    : sites_(at(problem.sites)), ways_(sites_ * sites_, kNever) {
  for (const TourTask& task : problem.tasks) work_.emplace_back(task.modes.size(), kNever);
  std::set<int> profiles;
  for (const TourVehicle& vehicle : problem.vehicles) profiles.insert(vehicle.profile);
  for (const int profile : profiles) add_profile(problem, profile, value);
}

void LeastLegs::add_profile(const TourProblem& problem, int profile,
                            const std::function<double(const TourLeg&)>& value) {
  const TourProfile& legs = problem.profiles[at(profile)];
  const auto of = [&](const TourLeg& leg) { return leg.cost < kNever ? value(leg) : kNever; };
  std::vector<double> ways(legs.ways.size());
  std::transform(legs.ways.begin(), legs.ways.end(), ways.begin(), of);
  // Floyd and Warshall, with the stations as the only sites between.
  for (const std::size_t s : station_sites(problem, profile)) {
    for (std::size_t a = 0; a < sites_; ++a) {
      const double there = ways[a * sites_ + s];
      if (!(there < kNever)) continue;
      for (std::size_t b = 0; b < sites_; ++b) {
        double& way = ways[a * sites_ + b];
        way = std::min(way, there + ways[s * sites_ + b]);
      }
    }
    bounded_ = bounded_ && ways[s * sites_ + s] >= 0.0;
  }
  for (std::size_t i = 0; i < ways.size(); ++i) ways_[i] = std::min(ways_[i], ways[i]);
  for (std::size_t t = 0; t < work_.size(); ++t) {
    for (std::size_t m = 0; m < work_[t].size(); ++m) {
      work_[t][m] = std::min(work_[t][m], of(legs.work[t][m]));
    }
  }
}

}  // namespace headland::tour
