// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/internal/completion_bound.hpp"

#include <algorithm>

namespace headland::tour {
namespace {

double price(const Model& model, const TourLeg& leg) {
  if (!(leg.cost < kNever)) return kNever;
  return leg.cost + model.problem().duration_weight * leg.duration_s;
}

// The cheapest way to `to` from wherever a vehicle of this kind may come from (but for one task),
// by any stations.
double cheapest_arrival(const Model& model, int kind_index, int to, int but_task) {
  const VehicleKind& kind = model.kind(kind_index);
  std::vector<double> from_station;  // Bellman-Ford over chains of stations
  for (const int s : kind.stations) {
    from_station.push_back(price(model, model.way(kind_index, model.station_site(s), to)));
  }
  for (std::size_t round = 0; round < kind.stations.size(); ++round) {
    for (std::size_t i = 0; i < kind.stations.size(); ++i) {
      for (std::size_t j = 0; j < kind.stations.size(); ++j) {
        const TourLeg& way = model.way(kind_index, model.station_site(kind.stations[i]),
                                       model.station_site(kind.stations[j]));
        from_station[i] = std::min(from_station[i], price(model, way) + from_station[j]);
      }
    }
  }
  const auto arrival = [&](int site) {
    double least = price(model, model.way(kind_index, site, to));
    for (std::size_t i = 0; i < kind.stations.size(); ++i) {
      const int station = model.station_site(kind.stations[i]);
      least = std::min(least, price(model, model.way(kind_index, site, station)) + from_station[i]);
    }
    return least;
  };
  double least = arrival(kind.vehicle.start);
  for (int t = 0; t < model.tasks(); ++t) {
    if (t == but_task) continue;
    for (const TourMode& mode : model.task(t).modes) {
      least = std::min(least, arrival(mode.exit));
    }
  }
  return least;
}

}  // namespace

CompletionBound::CompletionBound(const Model& model)
    : task_(static_cast<std::size_t>(model.tasks()), kNever) {
  for (int k = 0; k < static_cast<int>(model.kinds().size()); ++k) {
    const VehicleKind& kind = model.kind(k);
    finish_.push_back(cheapest_arrival(model, k, kind.vehicle.finish, -1));
    others_ += std::min(0.0, finish_.back() + kind.vehicle.fixed_cost) *
               static_cast<double>(kind.members.size());
    for (int t = 0; t < model.tasks(); ++t) {
      double& least = task_[static_cast<std::size_t>(t)];
      for (int m = 0; m < model.modes(t); ++m) {
        const double arrival = cheapest_arrival(model, k, model.mode({t, m}).entry, t);
        least = std::min(least, arrival + price(model, model.work(k, {t, m})));
      }
    }
  }
  for (int t = 0; t < model.tasks(); ++t) {
    double& least = task_[static_cast<std::size_t>(t)];
    least = std::min(least, model.task(t).reward);
  }
}

double CompletionBound::whole() const {
  double sum = others_;
  for (const double least : task_) sum += least;
  return sum;
}

}  // namespace headland::tour
