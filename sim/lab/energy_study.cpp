// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/energy_study.hpp"

#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "core/base/random.hpp"
#include "core/world/ground.hpp"
#include "global_planner/roadmap/roadmap.hpp"
#include "sim/lab/goal_tour.hpp"
#include "sim/lab/parallel.hpp"
#include "sim/lab/statistics.hpp"

namespace headland {
namespace {

constexpr double kBorder = 15.0;  // of the pasture, without goals [m]

// What a tour takes, whatever it was planned for.
struct PricedTour {
  DriveCost cost;
  double climb_m = 0.0;
};

struct Pair {
  PricedTour least_energy;
  PricedTour shortest;
};

class Pasture {
 public:
  Pasture(const EnergyStudyConfig& config, int run)
      : config_(config), seed_(static_cast<std::uint64_t>(config.seed + run)) {
    HillSpec hills;
    hills.seed = seed_;
    hills.relief_m = config.relief_m;
    hills.wavelength_m = config.wavelength_m;
    hills.cell_m = config.cell_m;
    const Point2 corner(config.side_m, config.side_m);
    ground_ = Ground(Farm{}, Terrain::hills(hills, Point2(-kBorder, -kBorder),
                                            corner + Point2(kBorder, kBorder)));
    area_ = Region({{{{0.0, 0.0}, {corner.x(), 0.0}, corner, {0.0, corner.y()}}, {}}});
    RandomStream random(seed_, "study/energy/goals");
    for (int g = 0; g <= config.goals_count; ++g) {
      Point2 at;
      do {
        at.x() = random.uniform(kBorder, config.side_m - kBorder);
        at.y() = random.uniform(kBorder, config.side_m - kBorder);
      } while (!gentle(at));
      const Pose2 pose{at.x(), at.y(), random.uniform(-kPi, kPi)};
      goals_.push_back({pose, pose, fmt::format("goal {}", g)});
    }
  }

  Result<Pair> tours() const {
    RoadmapOptions options;
    options.samples = config_.samples_count;
    options.seed = seed_;
    const auto roadmap = Roadmap::build(area_, ground_, config_.vehicle, options);
    if (!roadmap) return tl::unexpected<Error>(roadmap.error());
    const auto least = tour(*roadmap, Objective::kEnergy);
    if (!least) return tl::unexpected<Error>(least.error());
    const auto shortest = tour(*roadmap, Objective::kLength);
    if (!shortest) return tl::unexpected<Error>(shortest.error());
    return Pair{*least, *shortest};
  }

 private:
  // The best tour for an objective, priced in full.
  Result<PricedTour> tour(const Roadmap& roadmap, Objective objective) const {
    const auto graph = roadmap.connect(goals_, objective);
    if (!graph) return tl::unexpected<Error>(graph.error());
    const auto order = round_tour(graph->goals(), [&](int from, int to) {
      return graph->edge(from, to).cost.value(objective);
    });
    if (!order) return tl::unexpected<Error>(order.error());
    PricedTour tour;
    int at = 0;
    for (const int goal : *order) {
      add(graph->edge(at, goal), tour);
      at = goal;
    }
    add(graph->edge(at, 0), tour);
    return tour;
  }

  void add(const GoalGraph::Edge& edge, PricedTour& tour) const {
    tour.cost += edge.cost;
    double before = height(edge.path.start_pose().position());
    for (const PathSample& sample : edge.path.sample(config_.cell_m)) {
      const double now = height(sample.pose.position());
      tour.climb_m += std::max(0.0, now - before);
      before = now;
    }
  }

  // Goals lie where a vehicle can stand in any heading, with room for ways up to them.
  bool gentle(const Point2& at) const {
    const auto sample = ground_.sample(at);
    const double most =
        0.5 * deg_to_rad(std::min(config_.vehicle.max_pitch_deg, config_.vehicle.max_roll_deg));
    return sample && std::atan(sample->gradient.norm()) < most;
  }

  double height(const Point2& at) const {
    const auto sample = ground_.sample(at);
    return sample ? sample->height : 0.0;
  }

  const EnergyStudyConfig& config_;
  std::uint64_t seed_;
  Ground ground_;
  Region area_;
  std::vector<Site> goals_;
};

StudyCell tour_cell(const std::string& name, const std::vector<Pair>& pairs,
                    PricedTour Pair::*tour) {
  StudyCell cell{name, static_cast<int>(pairs.size())};
  const auto metric = [&](const std::string& key, auto value) {
    std::vector<double> sample;
    for (const Pair& pair : pairs) sample.push_back(value(pair.*tour));
    cell.metrics.emplace_back(key, summarize(std::move(sample)));
  };
  metric("energy_j", [](const PricedTour& t) { return t.cost.energy_j; });
  metric("length_m", [](const PricedTour& t) { return t.cost.length_m; });
  metric("climb_m", [](const PricedTour& t) { return t.climb_m; });
  return cell;
}

StudyCell saving_cell(const std::string& name, const std::vector<Pair>& pairs) {
  StudyCell cell{name, static_cast<int>(pairs.size())};
  std::vector<double> energy;
  std::vector<double> length;
  for (const Pair& pair : pairs) {
    energy.push_back(1.0 - pair.least_energy.cost.energy_j / pair.shortest.cost.energy_j);
    length.push_back(pair.least_energy.cost.length_m / pair.shortest.cost.length_m - 1.0);
  }
  cell.metrics.emplace_back("energy_ratio", summarize(std::move(energy)));
  cell.metrics.emplace_back("length_ratio", summarize(std::move(length)));
  return cell;
}

Plot saving_plot(const std::string& title, const std::vector<Pair>& pairs) {
  PlotSeries shortest{"shortest tour"};
  PlotSeries least{"tour of least energy"};
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    shortest.x.push_back(static_cast<double>(i + 1));
    shortest.y.push_back(pairs[i].shortest.cost.energy_j / 3600.0);
    least.x.push_back(static_cast<double>(i + 1));
    least.y.push_back(pairs[i].least_energy.cost.energy_j / 3600.0);
  }
  return {"Energy of both tours, terrain by terrain: " + title,
          "terrain",
          "energy [Wh]",
          {std::move(shortest), std::move(least)}};
}

Result<std::vector<Pair>> all_pairs(const EnergyStudyConfig& config, int jobs) {
  std::vector<Pair> pairs(static_cast<std::size_t>(config.runs_count));
  std::vector<std::optional<Error>> errors(pairs.size());
  parallel_for(config.runs_count, jobs, [&](int run) {
    const auto i = static_cast<std::size_t>(run);
    const auto tours = Pasture(config, run).tours();
    if (tours) {
      pairs[i] = *tours;
    } else {
      errors[i] = tours.error();
    }
  });
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (!errors[i]) continue;
    errors[i]->what = fmt::format("terrain {}: {}", i + 1, errors[i]->what);
    return tl::unexpected<Error>(*errors[i]);
  }
  return pairs;
}

}  // namespace

std::optional<Error> EnergyStudyConfig::check() const {
  constexpr double kMostCells = 25e6;
  if (side_m / cell_m * side_m / cell_m <= kMostCells) return std::nullopt;
  return Error{
      ErrorCode::kOutOfRange, "more than 25 million cells", "a larger cell_m", {{}, 0, "cell_m"}};
}

Result<StudyResult> run_energy_study(const EnergyStudyConfig& config, int jobs) {
  StudyResult result{config.study};
  for (const double ratio : config.recuperations_ratio) {
    EnergyStudyConfig with = config;
    with.vehicle.energy.recuperation_efficiency_ratio = ratio;
    const auto pairs = all_pairs(with, jobs);
    if (!pairs) return tl::unexpected<Error>(pairs.error());
    const std::string name = fmt::format("recuperation_{}", ratio);
    result.cells.push_back(saving_cell(name + "/saving", *pairs));
    result.cells.push_back(tour_cell(name + "/tour/energy", *pairs, &Pair::least_energy));
    result.cells.push_back(tour_cell(name + "/tour/length", *pairs, &Pair::shortest));
    result.plots.push_back(saving_plot(name, *pairs));
  }
  return result;
}

}  // namespace headland
