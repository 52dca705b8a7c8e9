// SPDX-License-Identifier: Apache-2.0
#include <exception>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "apps/command.hpp"

namespace {

using headland::apps::CommonOptions;

void add_common(CLI::App* command, CommonOptions& options, const char* file_name,
                const char* file_help) {
  command->add_option(file_name, options.file, file_help)->required();
  command->add_option("--out", options.out, "Directory for all files")->capture_default_str();
  command->add_flag("--json", options.json, "One JSON document on stdout and nothing else there");
  command->add_option("--set", options.set, "Override a key of the file, such as planner.seed=7")
      ->type_name("KEY=VALUE")
      ->take_all();
}

CLI::App* add_route(CLI::App& app, CommonOptions& options,
                    headland::apps::RouteOptions& route_options, std::string& out) {
  auto* route = app.add_subcommand(
      "route", "Solve a routing instance: TSPLIB TSP and ATSP, EVRP (CEC-12), E-VRPTW, OP");
  route->add_option("FILE", options.file, "Instance; its format is recognised by its content")
      ->required();
  route->add_option("--time-limit-s", route_options.time_limit_s, "Search at most this long")
      ->check(CLI::Range(1e-3, 1e6))
      ->capture_default_str();
  route->add_option("--seed", route_options.seed, "Seed of the search")->capture_default_str();
  route
      ->add_option("--iterations", route_options.iterations,
                   "Rounds of a single search; 0: searches until the time is up or three in a "
                   "row find nothing better")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  route->add_option("--out", out,
                    "Directory for solution.json and solution.sol; none: no "
                    "files");
  route->add_flag("--json", options.json, "One JSON document on stdout and nothing else there");
  return route;
}

int run(int argc, char** argv) {
  CLI::App app{"Headland: energy-aware planning and driving for farm robots"};
  app.require_subcommand(1);
  app.set_version_flag("--version", HEADLAND_VERSION);
  app.footer(
      "Examples:\n"
      "  headland plan config/missions/girona_orchard.yaml --out out/plan\n"
      "  headland run config/missions/girona_orchard.yaml --set simulation.seed=7\n"
      "  headland study config/studies/ebs221.yaml\n"
      "  headland perceive scan.pcd --set row_width_m=2.5\n"
      "  headland route kro124p.atsp --time-limit-s 20\n"
      "Exit codes: 0 done, 2 the input is wrong, 3 no feasible answer, 4 internal error");
  CommonOptions options;
  int code = 0;

  auto* plan = app.add_subcommand("plan", "Plan a mission: row order, turns, recharge stops");
  add_common(plan, options, "MISSION", "Mission file (YAML)");
  plan->callback([&] { code = headland::apps::plan_command(options); });

  auto* run = app.add_subcommand("run", "Plan a mission and drive it in the lock-step simulator");
  add_common(run, options, "MISSION", "Mission file (YAML)");
  std::uint64_t seed = 0;
  double realtime = 0.0;
  auto* seed_option = run->add_option("--seed", seed, "Seed of the simulation's noise");
  run->add_option("--realtime", realtime,
                  "Pace: 1 is real time, 10 ten times as fast; 0: no pacing")
      ->check(CLI::Range(0.0, 1e6));
  run->callback([&] {
    if (*seed_option) options.set.push_back(fmt::format("simulation.seed={}", seed));
    code = headland::apps::run_command(options, realtime);
  });

  auto* study = app.add_subcommand("study",
                                   "Run a study: a grid of scenarios, with statistics; one of "
                                   "episodes goes on where it was stopped");
  add_common(study, options, "STUDY", "Study file (YAML)");
  int jobs = 1;
  int max_episodes = 0;
  study->add_option("--jobs", jobs, "Episodes run at once")->check(CLI::PositiveNumber);
  study->add_option("--max-episodes", max_episodes, "At most this many episodes per cell; 0: all")
      ->check(CLI::NonNegativeNumber);
  study->callback([&] { code = headland::apps::study_command(options, jobs, max_episodes); });

  headland::apps::RouteOptions route_options;
  std::string route_out;
  add_route(app, options, route_options, route_out)->callback([&] {
    options.out = route_out;
    code = headland::apps::route_command(options, route_options);
  });

  auto* perceive = app.add_subcommand(
      "perceive", "Look at one lidar scan: ground, clusters, the row and its end");
  add_common(perceive, options, "CLOUD", "Points: .pcd, .ply, or .bin as KITTI's");
  perceive->callback([&] { code = headland::apps::perceive_command(options); });

  auto* doctor = app.add_subcommand("doctor", "Check the installation");
  doctor->add_flag("--json", options.json, "One JSON document on stdout and nothing else there");
  doctor->callback([&] { code = headland::apps::doctor_command(options); });

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& e) {
    fmt::print(stderr, "error: internal: {}; please report this with the command line\n", e.what());
    return 4;
  }
}
