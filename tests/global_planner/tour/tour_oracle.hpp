// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/base/random.hpp"
#include "global_planner/tour/tour_problem.hpp"

namespace headland::test {

/// A random small problem whose times and energies are whole numbers and whose chargers take half a
/// second for half a joule, or a second, so that charging by half joules is enough for an optimum.
struct SmallProblem {
  int tasks = 3;
  int vehicles = 1;
  int stations = 2;
  bool battery = true;
  bool windows = false;
  bool rewards = false;
  bool two_modes = false;
  bool downhill = false;  ///< some ways give energy back
  bool alike = true;      ///< all vehicles
  double duration_weight = 0.0;
  double span_weight = 0.0;
};

inline TourLeg random_leg(RandomStream& random, bool downhill) {
  TourLeg leg;
  leg.cost = 1 + random.index(9);
  leg.duration_s = 1 + random.index(4);
  leg.energy_j = downhill && random.index(4) == 0 ? -1 - random.index(2) : 1 + random.index(3);
  leg.peak_j = std::max(0.0, leg.energy_j) + (random.index(4) == 0 ? 1 : 0);
  return leg;
}

inline TourProblem make_problem(const SmallProblem& spec, std::uint64_t seed) {
  RandomStream random(seed, "small problem");
  TourProblem problem;
  const int places = spec.two_modes ? 2 * spec.tasks : spec.tasks;
  problem.sites = 1 + places + spec.stations;
  TourProfile profile;
  for (int i = 0; i < problem.sites * problem.sites; ++i) {
    profile.ways.push_back(random_leg(random, spec.downhill));
  }
  for (int t = 0; t < spec.tasks; ++t) {
    TourTask task;
    const int a = 1 + (spec.two_modes ? 2 * t : t);
    task.modes.push_back({a, spec.two_modes ? a + 1 : a});
    if (spec.two_modes) task.modes.push_back({a + 1, a});
    task.demand = 1 + random.index(3);
    if (spec.rewards) task.reward = 4 + random.index(12);
    if (spec.windows && random.index(3) > 0) {
      task.earliest_s = random.index(12);
      task.latest_s = task.earliest_s + 2 + random.index(10);
    }
    profile.work.emplace_back();
    for (std::size_t m = 0; m < task.modes.size(); ++m) {
      profile.work.back().push_back(random_leg(random, spec.downhill));
    }
    problem.tasks.push_back(task);
  }
  problem.profiles.push_back(profile);
  for (int s = 0; s < spec.stations; ++s) problem.stations.push_back({1 + places + s, 9});
  TourVehicle vehicle;
  for (int v = 0; v < spec.vehicles; ++v) {
    if (v == 0 || !spec.alike) {
      vehicle = {};
      vehicle.load_capacity = 4 + random.index(8);
      vehicle.fixed_cost = random.index(6);
      vehicle.latest_s = spec.windows ? 30 + random.index(20) : 60;
      if (spec.battery) {
        const double full = 8 + random.index(4);
        vehicle.battery_j = full;
        vehicle.start_energy_j = full - random.index(3);
        vehicle.reserve_j = random.index(3);
        vehicle.finish_energy_j = random.index(4);
        for (int s = 0; s < spec.stations; ++s) {
          const double knee = 3 + random.index(3);
          const std::array<ChargeFunction, 4> kinds{
              ChargeFunction{{{0, 0}, {full, full}}},                           // linear
              ChargeFunction{{{0, 0}, {knee, knee}, {2 * full - knee, full}}},  // slower at last
              ChargeFunction{{{0, 0}, {2 * knee, knee}, {full + knee, full}}},  // slower at first
              ChargeFunction{{{0, 0}, {0, full}}}};                             // at once
          vehicle.charging.push_back(kinds[static_cast<std::size_t>(random.index(4))]);
        }
      }
    }
    problem.vehicles.push_back(vehicle);
  }
  problem.duration_weight = spec.duration_weight;
  problem.span_weight = spec.span_weight;
  return problem;
}

/// The least cost by trying everything: every state (place, tasks done, half joules, half seconds)
/// that a vehicle can be in, then every way to share the tasks. Shares nothing with the solver.
class TourOracle {
 public:
  explicit TourOracle(const TourProblem& problem) : problem_(problem) {}

  double least_cost() {
    for (const TourVehicle& vehicle : problem_.vehicles) explore(vehicle);
    return share(0, 0, 0.0, -1.0);
  }

 private:
  static constexpr int kTimes = 121;  // half seconds up to 60
  struct Finish {
    double cost = kNever;
    double time_s = 0.0;
  };

  int masks() const { return 1 << problem_.tasks.size(); }
  int energies(const TourVehicle& v) const {
    return std::isfinite(v.battery_j) ? static_cast<int>(2 * v.battery_j) + 1 : 1;
  }
  double& cost(int mask, int site, int energy, int time) {
    return cost_[static_cast<std::size_t>(
        ((mask * problem_.sites + site) * levels_ + energy) * kTimes + time)];
  }

  // By growing sets and times: every move takes time or finishes a task.
  void explore(const TourVehicle& v) {
    levels_ = energies(v);
    cost_.assign(static_cast<std::size_t>(masks() * problem_.sites * levels_ * kTimes), kNever);
    finishes_.emplace_back(static_cast<std::size_t>(masks()));
    const bool battery = std::isfinite(v.battery_j);
    const int start = battery ? static_cast<int>(2 * v.start_energy_j) : 0;
    cost(0, v.start, start, static_cast<int>(2 * v.earliest_s)) = v.fixed_cost;
    for (int mask = 0; mask < masks(); ++mask) {
      for (int time = 0; time < kTimes; ++time) {
        for (int site = 0; site < problem_.sites; ++site) {
          for (int energy = 0; energy < levels_; ++energy) expand(v, mask, site, energy, time);
        }
      }
    }
  }

  // Energy (half joules) behind a leg, -1: impossible.
  int after(const TourVehicle& v, const TourLeg& leg, int energy) const {
    if (!(leg.cost < kNever)) return -1;
    if (!std::isfinite(v.battery_j)) return 0;
    if (energy / 2.0 - std::max(leg.peak_j, leg.energy_j) < v.reserve_j) return -1;
    return std::min(levels_ - 1, energy - static_cast<int>(2 * leg.energy_j));
  }

  void improve(int mask, int site, int energy, int time, double value) {
    if (time < kTimes)
      cost(mask, site, energy, time) = std::min(cost(mask, site, energy, time), value);
  }

  void expand(const TourVehicle& v, int mask, int site, int energy, int time) {
    const double here = cost(mask, site, energy, time);
    if (here == kNever) return;
    for (int t = 0; t < static_cast<int>(problem_.tasks.size()); ++t) {
      if (!(mask >> t & 1)) do_task(v, mask, site, energy, time, here, t);
    }
    for (std::size_t s = 0; s < v.charging.size(); ++s) {
      const int to = problem_.stations[s].site;
      if (v.charging[s].points.empty()) continue;
      const TourLeg& way = problem_.way(v.profile, site, to);
      const int arrival = after(v, way, energy);
      if (arrival < 0) continue;
      const int then = time + static_cast<int>(2 * way.duration_s);
      for (int full = arrival; full < levels_; ++full) {
        const double wait =
            duration(v.charging[s], full / 2.0) - duration(v.charging[s], arrival / 2.0);
        improve(mask, to, full, then + static_cast<int>(std::lround(2 * wait)), here + way.cost);
      }
    }
    finish(v, mask, site, energy, time, here);
  }

  void do_task(const TourVehicle& v, int mask, int site, int energy, int time, double here, int t) {
    const TourTask& task = problem_.tasks[static_cast<std::size_t>(t)];
    double load = task.demand;
    for (std::size_t u = 0; u < problem_.tasks.size(); ++u) {
      if (mask >> u & 1) load += problem_.tasks[u].demand;
    }
    if (load > v.load_capacity) return;
    for (std::size_t m = 0; m < task.modes.size(); ++m) {
      const TourLeg& way = problem_.way(v.profile, site, task.modes[m].entry);
      const TourLeg& work = problem_.profiles[static_cast<std::size_t>(v.profile)]
                                .work[static_cast<std::size_t>(t)][m];
      const int arrival = after(v, way, energy);
      if (arrival < 0) continue;
      const double begin = std::max(task.earliest_s, time / 2.0 + way.duration_s);
      const int done = after(v, work, arrival);
      if (begin > task.latest_s || done < 0) continue;
      improve(mask | 1 << t, task.modes[m].exit, done,
              static_cast<int>(2 * (begin + work.duration_s)), here + way.cost + work.cost);
    }
  }

  void finish(const TourVehicle& v, int mask, int site, int energy, int time, double here) {
    const TourLeg& way = problem_.way(v.profile, site, v.finish);
    const int left = after(v, way, energy);
    const double end = time / 2.0 + way.duration_s;
    if (mask == 0 || left < 0 || end > v.latest_s) return;
    if (std::isfinite(v.battery_j) && left / 2.0 < v.finish_energy_j) return;
    finishes_.back()[static_cast<std::size_t>(mask)].push_back({here + way.cost, end});
  }

  static double duration(const ChargeFunction& function, double energy) {
    for (std::size_t i = 1; i < function.points.size(); ++i) {
      const auto& a = function.points[i - 1];
      const auto& b = function.points[i];
      if (energy <= b.energy_j) {
        return a.time_s + (b.time_s - a.time_s) * (energy - a.energy_j) / (b.energy_j - a.energy_j);
      }
    }
    return function.points.back().time_s;
  }

  // The cheapest of what vehicles from `vehicle` on may do, if others have done `done`.
  double share(std::size_t vehicle, int done, double cost, double span) {
    if (vehicle == problem_.vehicles.size()) {
      for (std::size_t t = 0; t < problem_.tasks.size(); ++t) {
        if (!(done >> t & 1)) cost += problem_.tasks[t].reward;
      }
      return cost + problem_.span_weight * std::max(0.0, span);
    }
    double least = share(vehicle + 1, done, cost, span);
    for (int mask = 1; mask < masks(); ++mask) {
      if (mask & done) continue;
      for (const Finish& f : pareto(vehicle, mask)) {
        const double duration = f.time_s - problem_.vehicles[vehicle].earliest_s;
        least = std::min(least, share(vehicle + 1, done | mask,
                                      cost + f.cost + problem_.duration_weight * duration,
                                      std::max(span, f.time_s)));
      }
    }
    return least;
  }

  // Finishes that are cheapest for their time.
  const std::vector<Finish>& pareto(std::size_t vehicle, int mask) {
    auto& all = finishes_[vehicle][static_cast<std::size_t>(mask)];
    std::sort(all.begin(), all.end(), [](const Finish& a, const Finish& b) {
      return a.time_s != b.time_s ? a.time_s < b.time_s : a.cost < b.cost;
    });
    std::vector<Finish> best;
    for (const Finish& f : all) {
      if (best.empty() || f.cost < best.back().cost) best.push_back(f);
    }
    all = best;
    return all;
  }

  const TourProblem& problem_;
  int levels_ = 1;
  std::vector<double> cost_;
  std::vector<std::vector<std::vector<Finish>>> finishes_;  // of vehicle, set
};

}  // namespace headland::test
