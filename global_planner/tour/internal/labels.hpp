// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "global_planner/tour/internal/energy_curve.hpp"
#include "global_planner/tour/internal/model.hpp"

namespace headland::tour {

/// One way to have come here: its cost, and the earliest time by energy.
struct Label {
  double cost = 0.0;
  int first_point = 0;
  int points = 0;
  int before = -1;  ///< the label it was extended from, in the set before
  int stations =
      -1;  ///< the last station on the way here, as an index into Crossing's log; -1: none
};

/// Labels at one place, none of which is as good as another in cost, time and energy at once.
struct LabelSet {
  std::vector<Label> labels;
  std::vector<CurvePoint> points;

  std::span<const CurvePoint> curve(const Label& label) const {
    return {points.data() + label.first_point, static_cast<std::size_t>(label.points)};
  }
  bool empty() const { return labels.empty(); }
  void clear() {
    labels.clear();
    points.clear();
  }
};

/// What makes one label as good as another.
struct Dominance {
  double cost_slack = 0.0;
  double time_slack = 0.0;
  double energy_slack = 0.0;
  bool time_is_cost = false;
  double time_price = 0.0;  ///< where time is cost

  /// Adds a label unless one is as good, and drops those it is as good as. False if not added.
  bool add(LabelSet& set, const Label& label, std::span<const CurvePoint> curve) const;
};

/// Takes label sets from task to task, by way of any stations: the step of both the evaluation of
/// a given route and of the exact search.
class Crossing {
 public:
  enum class Effort {
    kExact,   ///< every station in every gap, all labels
    kThrifty  ///< stations not farther from both ends than another; one after another only where
              ///< one is not enough; few labels
  };
  Crossing(const Model& model, int kind, Effort effort);

  struct Passage {
    int station = 0;
    int before = -1;  ///< the station visited before it in the same gap; -1: none
  };
  /// The stations passed by the labels of all crossings since the last clear.
  const std::vector<Passage>& log() const { return log_; }
  void clear_log() { log_.clear(); }

  /// Labels of a vehicle that is about to leave its start.
  void start(LabelSet& to);
  /// What is known of the rest of a route on arrival somewhere.
  struct Outlook {
    double need_j = kNever;    ///< with which the finish is reached without stations, if at all
    double latest_s = kNever;  ///< after which it is too late for some visit
  };
  Outlook at_finish() const;
  /// On arrival at a visit, from that on arrival at the site after it.
  Outlook before(Visit visit, int to, const Outlook& next) const;
  /// From labels at the site `a` to labels on arrival at `b`.
  void cross(const LabelSet& from, int a, int b, const Outlook& outlook, LabelSet& to);
  /// Waits for the task's window and works.
  void work(const LabelSet& from, Visit visit, LabelSet& to);
  /// cross() to the finish, with the energy that must be left there.
  void finish(const LabelSet& from, int a, LabelSet& to);

  /// Labels worked on so far: a measure of effort that is the same on every machine.
  long labels_made() const { return labels_made_; }
  const Dominance& dominance() const { return dominance_; }

 private:
  struct Pending {
    int station = 0;
    int label = 0;
  };

  const ChargeFunction& charging(int station) const {
    return kind_.vehicle.charging[static_cast<std::size_t>(station)];
  }
  bool drive_curve(std::span<const CurvePoint> curve, const TourLeg& leg);
  void visit_stations(const Label& label, std::span<const CurvePoint> curve, int before, int a,
                      int b, double latest_s);
  void trim(LabelSet& set) const;
  std::span<const int> useful_stations(int a, int b);
  bool as_near(int other, int station, int a, int b) const;

  const Model& model_;
  int kind_index_;
  const VehicleKind& kind_;
  Dominance dominance_;
  Effort effort_;
  long labels_made_ = 0;
  std::vector<Passage> log_;
  std::vector<LabelSet> at_station_;
  std::vector<Pending> pending_;
  EnergyCurve curve_;              // of the label at hand
  EnergyCurve scratch_;            // for charging
  std::vector<int> useful_begin_;  // of each pair of sites, -1: not yet known
  std::vector<int> useful_;        // count, then stations, of each known pair
};

/// Energy needed before a leg, if `after_j` is needed behind it; infinity if the leg is impossible.
double need_before(const TourLeg& leg, double after_j, const BatteryLimits& battery);

}  // namespace headland::tour
