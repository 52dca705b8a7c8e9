// SPDX-License-Identifier: Apache-2.0
#include "global_planner/tour/internal/labels.hpp"

#include <algorithm>
#include <cmath>

namespace headland::tour {
namespace {

constexpr std::size_t kMostLabels = 8;    // of a thrifty crossing
constexpr int kLongestTable = 4'000'000;  // pairs of sites whose useful stations are remembered

// `better` costs no more than `label`, and offers as much energy as early.
bool as_good(const Dominance& rule, const Label& better, std::span<const CurvePoint> curve,
             const Label& label, std::span<const CurvePoint> other) {
  const double saved = label.cost - better.cost + rule.cost_slack;
  const auto suffices = [&](double lead) {
    return rule.time_is_cost ? saved + rule.time_price * lead >= 0.0
                             : saved >= 0.0 && lead >= -rule.time_slack;
  };
  if (curve.back().energy_j < other.back().energy_j - rule.energy_slack) return false;
  if (!suffices(other.front().time_s - curve.front().time_s)) return false;  // no lead is greater
  if (curve.size() == 1 && other.size() == 1) return true;
  return suffices(least_lead(curve, other, rule.energy_slack));
}

}  // namespace

bool Dominance::add(LabelSet& set, const Label& label, std::span<const CurvePoint> curve) const {
  for (const Label& other : set.labels) {
    if (as_good(*this, other, set.curve(other), label, curve)) return false;
  }
  std::erase_if(set.labels, [&](const Label& other) {
    return as_good(*this, label, curve, other, set.curve(other));
  });
  Label added = label;
  added.first_point = static_cast<int>(set.points.size());
  added.points = static_cast<int>(curve.size());
  set.points.insert(set.points.end(), curve.begin(), curve.end());
  set.labels.push_back(added);
  return true;
}

double need_before(const TourLeg& leg, double after_j, const BatteryLimits& battery) {
  if (!(leg.cost < kNever)) return kNever;
  const double need =
      std::max(after_j + leg.energy_j, battery.floor_j + std::max(leg.peak_j, leg.energy_j));
  return need <= battery.full_j ? need : kNever;
}

Crossing::Crossing(const Model& model, int kind, Effort effort)
    : model_(model),
      kind_index_(kind),
      kind_(model.kind(kind)),
      effort_(effort),
      at_station_(model.problem().stations.size()) {
  dominance_.cost_slack = model.cost_slack();
  dominance_.time_slack = model.time_slack();
  dominance_.energy_slack =
      std::isfinite(kind_.battery.full_j) ? 1e-10 * kind_.battery.full_j : 0.0;
  dominance_.time_is_cost = model.time_is_cost();
  dominance_.time_price = model.duration_price();
  const long pairs = static_cast<long>(model.problem().sites) * model.problem().sites;
  if (effort == Effort::kThrifty && kind_.stations.size() > 1 && pairs <= kLongestTable) {
    useful_begin_.assign(static_cast<std::size_t>(pairs), -1);
  }
}

void Crossing::start(LabelSet& to) {
  to.clear();
  const double time = model_.timeless() ? 0.0 : kind_.vehicle.earliest_s;
  const CurvePoint point{kind_.start_j, time};
  dominance_.add(to, Label{}, {&point, 1});
}

Crossing::Outlook Crossing::at_finish() const {
  return {kind_.finish_need_j, kind_.vehicle.latest_s + model_.time_slack()};
}

Crossing::Outlook Crossing::before(Visit visit, int to, const Outlook& next) const {
  const TourLeg& work = model_.work(kind_index_, visit);
  const TourLeg& way = model_.way(kind_index_, model_.mode(visit).exit, to);
  const double need = need_before(way, next.need_j, kind_.battery);
  return {need_before(work, need, kind_.battery),
          std::min(model_.task(visit.task).latest_s + model_.time_slack(),
                   next.latest_s - way.duration_s - work.duration_s)};
}

bool Crossing::drive_curve(std::span<const CurvePoint> curve, const TourLeg& leg) {
  ++labels_made_;
  if (!(leg.cost < kNever)) return false;
  curve_.assign(curve.begin(), curve.end());
  return drive(curve_, leg, model_.duration(leg), kind_.battery);
}

void Crossing::cross(const LabelSet& from, int a, int b, const Outlook& outlook, LabelSet& to) {
  to.clear();
  const TourLeg& direct = model_.way(kind_index_, a, b);
  const double need_here = need_before(direct, outlook.need_j, kind_.battery);
  bool stations = false;
  for (int i = 0; i < static_cast<int>(from.labels.size()); ++i) {
    const Label& label = from.labels[static_cast<std::size_t>(i)];
    const auto curve = from.curve(label);
    if (drive_curve(curve, direct)) {
      dominance_.add(to, {label.cost + direct.cost, 0, 0, i, -1}, curve_);
    }
    // With energy for all that is left, a station can only cost.
    if (kind_.detours_never_pay && curve.front().energy_j >= need_here) continue;
    if (kind_.stations.empty()) continue;
    if (!stations) {
      for (const int s : kind_.stations) at_station_[static_cast<std::size_t>(s)].clear();
      pending_.clear();
      stations = true;
    }
    Label origin = label;
    origin.before = i;
    visit_stations(origin, curve, -1, a, b, outlook.latest_s);
  }
  // Each station's labels go on to b, and to further stations; dominance ends this.
  for (std::size_t next = 0; stations && next < pending_.size(); ++next) {
    const Pending at = pending_[next];
    const LabelSet& here = at_station_[static_cast<std::size_t>(at.station)];
    const auto found = std::find_if(here.labels.begin(), here.labels.end(),
                                    [&](const Label& l) { return l.stations == at.label; });
    if (found == here.labels.end()) continue;  // a better one came since
    const Label label = *found;
    const std::vector<CurvePoint> curve(here.curve(label).begin(), here.curve(label).end());
    const int site = model_.station_site(at.station);
    const TourLeg& onward = model_.way(kind_index_, site, b);
    if (drive_curve(curve, onward)) {
      dominance_.add(to, {label.cost + onward.cost, 0, 0, label.before, label.stations}, curve_);
      if (effort_ == Effort::kThrifty && kind_.detours_never_pay) continue;
    }
    visit_stations(label, curve, at.station, site, b, outlook.latest_s);
  }
  if (effort_ == Effort::kThrifty) trim(to);
}

// Keeps the cheapest labels and the one with most energy.
void Crossing::trim(LabelSet& set) const {
  auto& labels = set.labels;
  if (labels.size() <= kMostLabels) return;
  const auto most_energy = [&](const Label& l) { return set.curve(l).back().energy_j; };
  const auto price = [&](const Label& l) {
    return l.cost + model_.duration_price() * set.curve(l).front().time_s;
  };
  std::iter_swap(labels.begin(), std::max_element(labels.begin(), labels.end(),
                                                  [&](const Label& x, const Label& y) {
                                                    return most_energy(x) < most_energy(y);
                                                  }));
  std::stable_sort(labels.begin() + 1, labels.end(),
                   [&](const Label& x, const Label& y) { return price(x) < price(y); });
  labels.resize(kMostLabels);
}

void Crossing::visit_stations(const Label& label, std::span<const CurvePoint> curve, int before,
                              int a, int b, double latest_s) {
  const bool hurry = kind_.detours_never_pay && latest_s < kNever;
  for (const int s : useful_stations(a, b)) {
    if (s == before) continue;
    const TourLeg& way = model_.way(kind_index_, a, model_.station_site(s));
    if (hurry && curve.front().time_s + way.duration_s +
                         model_.way(kind_index_, model_.station_site(s), b).duration_s >
                     latest_s) {
      continue;
    }
    if (!drive_curve(curve, way)) continue;
    if (kind_.detours_never_pay && curve_.front().energy_j >= kind_.battery.full_j) continue;
    charge(curve_, charging(s), kind_.battery.full_j, model_.timeless(), scratch_);
    const int passage = static_cast<int>(log_.size());
    const Label charged{label.cost + way.cost, 0, 0, label.before, passage};
    if (!dominance_.add(at_station_[static_cast<std::size_t>(s)], charged, curve_)) continue;
    log_.push_back({s, before < 0 ? -1 : label.stations});
    pending_.push_back({s, passage});
  }
}

void Crossing::work(const LabelSet& from, Visit visit, LabelSet& to) {
  to.clear();
  const TourTask& task = model_.task(visit.task);
  const TourLeg& leg = model_.work(kind_index_, visit);
  for (const Label& label : from.labels) {
    ++labels_made_;
    if (!(leg.cost < kNever)) return;
    const auto curve = from.curve(label);
    curve_.assign(curve.begin(), curve.end());
    if (model_.windows() &&
        !wait_window(curve_, task.earliest_s, task.latest_s + model_.time_slack())) {
      continue;
    }
    if (!drive(curve_, leg, model_.duration(leg), kind_.battery)) continue;
    dominance_.add(to, {label.cost + leg.cost, 0, 0, label.before, label.stations}, curve_);
  }
}

void Crossing::finish(const LabelSet& from, int a, LabelSet& to) {
  LabelSet arrived;
  cross(from, a, kind_.vehicle.finish, {kind_.finish_need_j, kNever}, arrived);
  to.clear();
  for (const Label& label : arrived.labels) {
    const auto curve = arrived.curve(label);
    curve_.assign(curve.begin(), curve.end());
    if (need_energy(curve_, kind_.finish_need_j)) dominance_.add(to, label, {curve_.data(), 1});
  }
}

// Whether one station serves the way from a to b at least as well as another, whatever the battery.
bool Crossing::as_near(int other, int station, int a, int b) const {
  const int o = model_.station_site(other);
  const int s = model_.station_site(station);
  const auto no_worse = [&](const TourLeg& x, const TourLeg& y) {
    return x.cost <= y.cost && x.energy_j <= y.energy_j && x.peak_j <= y.peak_j &&
           model_.duration(x) <= model_.duration(y);
  };
  if (!no_worse(model_.way(kind_index_, a, o), model_.way(kind_index_, a, s))) return false;
  if (!no_worse(model_.way(kind_index_, o, b), model_.way(kind_index_, s, b))) return false;
  const auto& p = charging(other).points;
  const auto& q = charging(station).points;
  if (p.size() != q.size()) return false;
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (p[i].energy_j != q[i].energy_j) return false;
    if (!model_.timeless() && p[i].time_s > q[i].time_s) return false;
  }
  return true;
}

std::span<const int> Crossing::useful_stations(int a, int b) {
  const auto& all = kind_.stations;
  if (effort_ == Effort::kExact || all.size() < 2 || useful_begin_.empty()) return all;
  const std::size_t pair =
      static_cast<std::size_t>(a) * static_cast<std::size_t>(model_.problem().sites) +
      static_cast<std::size_t>(b);
  if (useful_begin_[pair] < 0) {
    useful_begin_[pair] = static_cast<int>(useful_.size());
    useful_.push_back(0);
    for (const int s : all) {
      const bool beaten = std::any_of(all.begin(), all.end(), [&](int other) {
        return other != s && as_near(other, s, a, b) && (other < s || !as_near(s, other, a, b));
      });
      if (!beaten) useful_.push_back(s);
    }
    const auto begin = static_cast<std::size_t>(useful_begin_[pair]);
    useful_[begin] = static_cast<int>(useful_.size() - begin) - 1;
  }
  const auto begin = static_cast<std::size_t>(useful_begin_[pair]);
  return {useful_.data() + begin + 1, static_cast<std::size_t>(useful_[begin])};
}

}  // namespace headland::tour
