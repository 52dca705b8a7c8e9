// SPDX-License-Identifier: Apache-2.0
#include "global_planner/mission/internal/tour_model.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "global_planner/mission/internal/free_ways.hpp"
#include "global_planner/mission/internal/standing_places.hpp"

namespace headland::mission {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr DriveCost kNoWay{kInfinity, kInfinity, kInfinity, kInfinity};
constexpr int kMostPieces = 64;  // of a row

std::vector<Site> stops_of(const Mission& mission) {
  std::vector<Site> stops;
  const auto add = [&stops](const Pose2& pose, std::string name) {
    stops.push_back({pose, pose, std::move(name)});
  };
  for (const MissionVehicle& v : mission.vehicles) add(v.start, "start of " + v.id);
  for (const MissionVehicle& v : mission.vehicles) add(v.finish, "finish of " + v.id);
  for (const Charger& c : mission.farm.chargers) add(c.pose, "charger " + c.id);
  for (const Visit& v : mission.visits) {
    const Poi& poi = mission.farm.pois[static_cast<std::size_t>(v.poi)];
    add(poi.pose, poi.id);
  }
  return stops;
}

}  // namespace

const Vehicle& TourModel::vehicle_of(const Profile& profile) const {
  return mission_->vehicles[static_cast<std::size_t>(profile.vehicle)].vehicle;
}

const TourModel::Profile& TourModel::profile_of(int vehicle) const {
  return profiles_[static_cast<std::size_t>(
      profile_of_vehicle_[static_cast<std::size_t>(vehicle)])];
}

// Recharging is planned as if driving drew more, and recuperated less, than the model says.
double TourModel::margined(double energy) const {
  const double margin = mission_->config.planner.energy_margin_ratio;
  return energy + margin * std::abs(energy);
}

Result<TourModel> TourModel::build(const Mission& mission) {
  TourModel model(mission);
  if (auto error = check_standing_places(mission)) return tl::unexpected<Error>(std::move(*error));
  if (auto done = model.build_profiles(); !done) return tl::unexpected<Error>(done.error());
  if (auto done = model.split_rows(); !done) return tl::unexpected<Error>(done.error());
  model.price_work();
  model.build_problem();
  return model;
}

// Vehicles of one model and payload drive alike.
Result<void> TourModel::build_profiles() {
  const PlannerConfig& planner = mission_->config.planner;
  TransitionOptions options;
  options.objective = mission_->config.cost_weights();
  options.margin_m = planner.margin_m;
  options.fishtail = planner.fishtail;
  options.reeds_shepp = planner.reeds_shepp;
  for (int v = 0; v < vehicles(); ++v) {
    const auto& mine = mission_->config.vehicles[static_cast<std::size_t>(v)];
    const auto same = std::find_if(profiles_.begin(), profiles_.end(), [&](const Profile& p) {
      const auto& other = mission_->config.vehicles[static_cast<std::size_t>(p.vehicle)];
      return other.model == mine.model && other.payload_kg == mine.payload_kg;
    });
    profile_of_vehicle_.push_back(static_cast<int>(same - profiles_.begin()));
    if (same != profiles_.end()) continue;
    const Vehicle& vehicle = mission_->vehicles[static_cast<std::size_t>(v)].vehicle;
    auto ways = Transitions::build(mission_->farm, mission_->ground, mission_->rows,
                                   stops_of(*mission_), vehicle, options);
    if (!ways) return tl::unexpected<Error>(ways.error());
    if (auto offered = offer_free_ways(*mission_, vehicle, *ways); !offered) {
      return tl::unexpected<Error>(offered.error());
    }
    profiles_.push_back({v, std::move(*ways), {}});
    if (auto error = row_error(profiles_.back())) return tl::unexpected<Error>(std::move(*error));
  }
  return {};
}

// A row that leaves the terrain or is too steep, if there is one.
std::optional<Error> TourModel::row_error(const Profile& profile) const {
  if (mission_->ground.flat()) return std::nullopt;
  const Vehicle& vehicle = vehicle_of(profile);
  for (int r = 0; r < rows(); ++r) {
    const Path path = row_stretch(vehicle, r, 0, 0.0, 1.0);
    if (auto error = check_slopes(vehicle, mission_->ground, path)) {
      const RowRef ref = mission_->rows[static_cast<std::size_t>(r)];
      error->what = fmt::format("row {}: {}", mission_->farm.row_name(ref), error->what);
      return error;
    }
  }
  return std::nullopt;
}

Path TourModel::row_stretch(const Vehicle& vehicle, int row, int entry, double from,
                            double to) const {
  const Row& line = mission_->farm.row(mission_->rows[static_cast<std::size_t>(row)]);
  Path path = row_path(line, entry, vehicle.turning_radius());
  if (from <= 0.0 && to >= 1.0) return path;
  const double length = path.length();
  return entry == 0 ? path.slice(from * length, to * length)
                    : path.slice((1.0 - to) * length, (1.0 - from) * length);
}

DriveCost TourModel::price(const Vehicle& vehicle, const Path& path, LegKind kind) const {
  if (path.empty()) return {};
  const auto cost = path_cost(vehicle, mission_->ground, path, kind);
  return cost ? *cost : kNoWay;
}

// Whether a stretch of a row can be worked from a full battery between two visits to chargers, in
// either direction; else by how much the battery is short.
bool TourModel::lasts(const Profile& profile, int vehicle, int row, double begin, double end,
                      double& short_j) const {
  const Vehicle& driven = vehicle_of(profile);
  const Battery& battery = mission_->vehicles[static_cast<std::size_t>(vehicle)].vehicle.battery;
  const double usable = battery.capacity_j() - battery.reserve_j();
  for (const int entry : {0, 1}) {
    const int in = 2 * row + entry;
    const int out = 2 * row + 1 - entry;
    const double before = entry == 0 ? begin : 1.0 - end;
    const double behind = entry == 0 ? end : 1.0 - begin;
    const auto stretch = [&](double from, double to, LegKind kind) {
      const double a = entry == 0 ? from : 1.0 - to;
      const double b = entry == 0 ? to : 1.0 - from;
      return b > a ? price(driven, row_stretch(driven, row, entry, a, b), kind) : DriveCost{};
    };
    const DriveCost inside = stretch(0.0, before, LegKind::kTransit) +
                             stretch(before, behind, LegKind::kRow) +
                             stretch(behind, 1.0, LegKind::kTransit);
    for (int c = 0; c < chargers(); ++c) {
      DriveCost trip = profile.ways.cost(charger(c), in) + inside;
      trip += DriveCost{0.0, 0.0, 0.0, escape_j(vehicle, out)};
      const double missing = margined(trip.peak_j) - usable;
      if (missing <= 0.0) return true;
      short_j = std::min(short_j, missing);
    }
  }
  return false;
}

// Fractions at which a row is cut so that each stretch lasts from charge to charge: as few equal
// stretches as will do. None where no battery needs it, or the farm has no charger to cut for.
Result<std::vector<double>> TourModel::cuts_of(int row) const {
  std::vector<double> cuts;
  if (chargers() == 0) return cuts;
  double short_j = kInfinity;
  for (int pieces = 1; pieces <= kMostPieces; ++pieces) {
    const auto piece_lasts = [&](int k) {
      for (int v = 0; v < vehicles(); ++v) {
        if (lasts(profile_of(v), v, row, static_cast<double>(k) / pieces,
                  static_cast<double>(k + 1) / pieces, short_j)) {
          return true;
        }
      }
      return false;
    };
    bool all = true;
    for (int k = 0; k < pieces && all; ++k) all = piece_lasts(k);
    if (!all) continue;
    for (int k = 1; k < pieces; ++k) cuts.push_back(static_cast<double>(k) / pieces);
    return cuts;
  }
  if (mission_->config.allow_dropping || !std::isfinite(short_j)) return cuts;
  const RowRef ref = mission_->rows[static_cast<std::size_t>(row)];
  return fail(
      ErrorCode::kEnergyInfeasible,
      fmt::format("row {}: the battery is short of {:.0f} Wh to reach it from a charger, work "
                  "a part of it and return",
                  mission_->farm.row_name(ref), std::ceil(short_j / 3600.0)),
      "a larger battery, a lower reserve_soc, a nearer charger, or allow_dropping: true");
}

Result<void> TourModel::split_rows() {
  for (int r = 0; r < rows(); ++r) {
    const auto cuts = cuts_of(r);
    if (!cuts) return tl::unexpected<Error>(cuts.error());
    double begin = 0.0;
    for (const double at : *cuts) {
      tasks_.push_back({r, -1, begin, at});
      cuts_.push_back({r, at, 0});
      cuts_.push_back({r, at, 1});
      begin = at;
    }
    tasks_.push_back({r, -1, begin, 1.0});
  }
  for (int v = 0; v < visits(); ++v) tasks_.push_back({-1, v});
  return {};
}

void TourModel::price_work() {
  for (Profile& profile : profiles_) {
    const Vehicle& vehicle = vehicle_of(profile);
    for (const ModelTask& task : tasks_) {
      std::vector<DriveCost> modes;
      if (task.visit >= 0) {
        const double dwell = mission_->visits[static_cast<std::size_t>(task.visit)].dwell_s;
        const EnergyModel& model = vehicle.energy;
        const double energy = (model.base_power_w + model.implement_power_w) * dwell;
        modes.push_back({0.0, dwell, energy, energy});
      } else {
        for (const int entry : {0, 1}) {
          modes.push_back(price(
              vehicle, row_stretch(vehicle, task.row, entry, task.begin, task.end), LegKind::kRow));
        }
      }
      profile.work.push_back(std::move(modes));
    }
  }
}

const TourModel::Cut* TourModel::cut_of(int site) const {
  return site < base_sites() ? nullptr : &cuts_[static_cast<std::size_t>(site - base_sites())];
}

int TourModel::cut_site(int row, double at, int entry) const {
  if (at <= 0.0) return 2 * row;
  if (at >= 1.0) return 2 * row + 1;
  for (std::size_t c = 0; c < cuts_.size(); ++c) {
    if (cuts_[c].row == row && cuts_[c].at == at && cuts_[c].entry == entry) {
      return base_sites() + static_cast<int>(c);
    }
  }
  return -1;
}

// Whether a cut's way leads on along its row to another cut.
bool TourModel::ahead(const Cut* a, const Cut* b) {
  if (a == nullptr || b == nullptr || a->row != b->row || a->entry != b->entry) return false;
  return a->entry == 0 ? b->at > a->at : b->at < a->at;
}

// The base sites between which a way runs outside the rows that are cut; none if there is no way.
std::optional<TourMode> TourModel::outside(const Profile& profile, int from, int to) const {
  const Cut* a = cut_of(from);
  const Cut* b = cut_of(to);
  const int out = a == nullptr ? from : 2 * a->row + 1 - a->entry;
  const int in = b == nullptr ? to : 2 * b->row + b->entry;
  if (out == in || !std::isfinite(profile.ways.cost(out, in).energy_j)) return std::nullopt;
  return TourMode{out, in};
}

DriveCost TourModel::way(const Profile& profile, int from, int to) const {
  const Cut* a = cut_of(from);
  const Cut* b = cut_of(to);
  if (a == nullptr && b == nullptr) return from == to ? kNoWay : profile.ways.cost(from, to);
  if (from == to) return {};
  if (!ahead(a, b) && !outside(profile, from, to)) return kNoWay;
  return price(vehicle_of(profile), way_path(profile.vehicle, from, to), LegKind::kTransit);
}

// Ways from and to cuts lead along the row, implement up.
Path TourModel::way_path(int vehicle, int from, int to) const {
  const Profile& profile = profile_of(vehicle);
  const Cut* a = cut_of(from);
  const Cut* b = cut_of(to);
  if (from == to) return {};
  const auto stretch = [&](const Cut& cut, double begin, double end) {
    return row_stretch(vehicle_of(profile), cut.row, cut.entry, std::min(begin, end),
                       std::max(begin, end));
  };
  if (ahead(a, b)) return stretch(*a, a->at, b->at);
  const auto between = outside(profile, from, to);
  if (!between) return {};
  Path path;
  if (a != nullptr) path.append(stretch(*a, a->at, a->entry == 0 ? 1.0 : 0.0));
  path.append(profile.ways.path(between->entry, between->exit));
  if (b != nullptr) path.append(stretch(*b, b->entry == 0 ? 0.0 : 1.0, b->at));
  return path;
}

LegKind TourModel::way_kind(int vehicle, int from, int to) const {
  if (cut_of(from) != nullptr || cut_of(to) != nullptr) return LegKind::kTransit;
  return profile_of(vehicle).ways.kind(from, to);
}

DriveCost TourModel::way_cost(int vehicle, int from, int to) const {
  return way(profile_of(vehicle), from, to);
}

DriveCost TourModel::work_cost(int vehicle, int task, int mode) const {
  return profile_of(vehicle).work[static_cast<std::size_t>(task)][static_cast<std::size_t>(mode)];
}

Path TourModel::work_path(int vehicle, int task, int mode) const {
  const ModelTask& work = tasks_[static_cast<std::size_t>(task)];
  if (work.visit >= 0) return {};
  return row_stretch(vehicle_of(profile_of(vehicle)), work.row, mode, work.begin, work.end);
}

double TourModel::escape_j(int vehicle, int site) const {
  if (chargers() == 0) return 0.0;
  double least = kInfinity;
  for (int c = 0; c < chargers(); ++c) {
    if (site == charger(c)) return 0.0;
    least = std::min(least, way(profile_of(vehicle), site, charger(c)).peak_j);
  }
  return least;
}

std::string TourModel::leg_id(int task) const {
  const ModelTask& work = tasks_[static_cast<std::size_t>(task)];
  if (work.visit >= 0) {
    const Visit& visited = mission_->visits[static_cast<std::size_t>(work.visit)];
    return mission_->farm.pois[static_cast<std::size_t>(visited.poi)].id;
  }
  return mission_->farm.row_name(mission_->rows[static_cast<std::size_t>(work.row)]);
}

std::string TourModel::task_name(int task) const {
  return (tasks_[static_cast<std::size_t>(task)].visit >= 0 ? "visit " : "row ") + leg_id(task);
}

std::string TourModel::named(std::string text, bool keep_subject) const {
  static constexpr std::string_view kWord = "task ";
  const auto at = text.find(kWord);
  if (at == std::string::npos) return text;
  const auto begin = at + kWord.size();
  const auto end = std::min(text.find_first_not_of("0123456789", begin), text.size());
  if (end == begin || end - begin > 7) return text;
  const int task = std::stoi(text.substr(begin, end - begin));
  if (task >= static_cast<int>(tasks_.size())) return text;
  if (!keep_subject && at == 0 && text.compare(end, 2, ": ") == 0) return text.substr(end + 2);
  return text.replace(at, end - at, task_name(task));
}

std::string TourModel::site_name(int site) const {
  const Cut* cut = cut_of(site);
  if (cut == nullptr) return profiles_.front().ways.site(site).name;
  const RowRef ref = mission_->rows[static_cast<std::size_t>(cut->row)];
  return fmt::format("row {} at {:.0f} m", mission_->farm.row_name(ref),
                     cut->at * length(mission_->farm.row(ref).line));
}

}  // namespace headland::mission
