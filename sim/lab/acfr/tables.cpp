// SPDX-License-Identifier: Apache-2.0
#include "sim/lab/acfr/tables.hpp"

#include <array>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace headland {
namespace {

constexpr std::array<std::string_view, 2> kDensities{"dense", "sparse"};
constexpr std::array<std::string_view, 3> kAccuracies{"5m", "2m", "1m"};

// (003) Tables I to III.
struct Published {
  std::string_view planner;
  std::array<double, 6> fail_1min;  // [%]: dense 5, 2, 1 m, sparse 5, 2, 1 m
  std::array<double, 6> fail_5min;
  std::array<double, 4> displacement;  // [m]: dense median and std, sparse
  std::array<double, 6> least;         // dense: near-collisions [%], median and std [m]; sparse
};
constexpr std::array<Published, 3> kPublished{Published{"mcts",
                                                        {0, 0.4, 2.8, 0, 0, 0.4},
                                                        {0, 0.4, 0.6, 0, 0, 0},
                                                        {1.63, 22.57, 0.28, 13.5},
                                                        {4.70, 2.61, 1.07, 0.71, 3.81, 1.72}},
                                              Published{"pf",
                                                        {0, 1.5, 4.6, 0, 0.5, 1.0},
                                                        {0, 0.5, 0.8, 0, 0, 0.7},
                                                        {3.9, 37.50, 0.20, 12.26},
                                                        {5.07, 2.54, 1.00, 0.62, 3.78, 1.78}},
                                              Published{"fs",
                                                        {2.4, 8.5, 28.0, 0, 3.7, 8.6},
                                                        {0, 2.9, 9.8, 0, 0, 1.2},
                                                        {0.05, 5.13, 0.06, 3.05},
                                                        {3.25, 2.63, 0.95, 1.34, 3.62, 1.63}}};

const Published* published(std::string_view planner) {
  for (const Published& p : kPublished) {
    if (p.planner == planner) return &p;
  }
  return nullptr;
}

std::string name(std::string_view planner, std::string_view density, std::string_view accuracy) {
  return fmt::format("{}/{}/{}", planner, density, accuracy);
}

// The planners of the cells, in their order.
std::vector<std::string> planners_of(const StudyResult& result) {
  std::vector<std::string> planners;
  for (const StudyCell& cell : result.cells) {
    const std::string planner = cell.name.substr(0, cell.name.find('/'));
    if (planners.empty() || planners.back() != planner) planners.push_back(planner);
  }
  return planners;
}

std::string beside(const std::string& ours, const Published* seed, double theirs, int digits) {
  return seed == nullptr ? ours : fmt::format("{} ({:.{}f})", ours, theirs, digits);
}

std::string share(const StudyCell* cell, const char* metric) {
  const Statistic* s = cell == nullptr ? nullptr : cell->find(metric);
  if (s == nullptr) return "-";
  return fmt::format("{:.1f} [{:.1f}, {:.1f}]", 100.0 * s->mean,
                     100.0 * s->ci_low.value_or(s->mean), 100.0 * s->ci_high.value_or(s->mean));
}

StudyTable failures(const StudyResult& result) {
  StudyTable table{"Table I: waypoints not reached [%], ours with 95 % interval (seed 003)",
                   {"timeout", "planner"},
                   {}};
  for (const auto density : kDensities) {
    for (const auto accuracy : kAccuracies) {
      table.header.push_back(fmt::format("{} {}", density, accuracy));
    }
  }
  for (const bool longer : {false, true}) {
    for (const std::string& planner : planners_of(result)) {
      std::vector<std::string> row{longer ? "5 min" : "1 min", planner};
      const Published* seed = published(planner);
      std::size_t column = 0;
      for (const auto density : kDensities) {
        for (const auto accuracy : kAccuracies) {
          const double theirs =
              seed == nullptr ? 0.0 : (longer ? seed->fail_5min : seed->fail_1min)[column];
          ++column;
          row.push_back(beside(share(result.find(name(planner, density, accuracy)),
                                     longer ? "fail_5min" : "fail_1min"),
                               seed, theirs, 1));
        }
      }
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

// A row of a table over densities; all accuracies together are the cell `<planner>/<density>`.
template <class Columns>
StudyTable by_density(const StudyResult& result, StudyTable table, const Columns& columns) {
  for (const std::string& planner : planners_of(result)) {
    std::vector<std::string> row{planner};
    for (std::size_t d = 0; d < kDensities.size(); ++d) {
      columns(result.find(fmt::format("{}/{}", planner, kDensities[d])), published(planner), d,
              row);
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string number(const std::optional<double>& value) {
  return value ? fmt::format("{:.2f}", *value) : "-";
}

StudyTable displacements(const StudyResult& result) {
  return by_density(
      result,
      {"Table II: displacement from the path of least energy [m] (seed 003)",
       {"planner", "dense: median", "std", "p95", "sparse: median", "std", "p95"},
       {}},
      [](const StudyCell* cell, const Published* seed, std::size_t d,
         std::vector<std::string>& row) {
        const Statistic* s = cell == nullptr ? nullptr : cell->find("displacement_m");
        if (s == nullptr) return row.insert(row.end(), {"-", "-", "-"}), void();
        const std::size_t at = 2 * d;
        row.push_back(beside(number(s->median), seed, seed ? seed->displacement[at] : 0.0, 2));
        row.push_back(beside(number(s->std), seed, seed ? seed->displacement[at + 1] : 0.0, 2));
        row.push_back(number(s->p95));
      });
}

StudyTable distances(const StudyResult& result) {
  return by_density(
      result,
      {"Table III: least distance to agents, of interactions (seed 003)",
       {"planner", "dense: < 2 m %", "median m", "std m", "robot's fault %", "sparse: < 2 m %",
        "median m", "std m", "robot's fault %"},
       {}},
      [](const StudyCell* cell, const Published* seed, std::size_t d,
         std::vector<std::string>& row) {
        const Statistic* s = cell == nullptr ? nullptr : cell->find("least_m");
        if (s == nullptr) return row.insert(row.end(), {"-", "-", "-", "-"}), void();
        const std::size_t at = 3 * d;
        row.push_back(beside(share(cell, "near_collision"), seed, seed ? seed->least[at] : 0.0, 2));
        row.push_back(beside(number(s->median), seed, seed ? seed->least[at + 1] : 0.0, 2));
        row.push_back(beside(number(s->std), seed, seed ? seed->least[at + 2] : 0.0, 2));
        row.push_back(share(cell, "robot_near"));
      });
}

}  // namespace

void add_acfr_tables(StudyResult& result) {
  result.tables.push_back(failures(result));
  result.tables.push_back(displacements(result));
  result.tables.push_back(distances(result));
}

}  // namespace headland
