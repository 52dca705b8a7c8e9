// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "apps/command.hpp"
#include "core/config/yaml.hpp"
#include "core/model/vehicle.hpp"

namespace headland::apps {
namespace {

struct Check {
  std::string name;
  bool ok = false;
  std::string detail;
};

Check check_writable(const std::filesystem::path& directory) {
  const auto probe = directory / ".headland-doctor";
  std::ofstream stream(probe);
  stream << "x";
  stream.close();
  const bool ok = static_cast<bool>(stream);
  std::error_code code;
  std::filesystem::remove(probe, code);
  return {"working directory is writable", ok, std::filesystem::absolute(directory).string()};
}

Check check_shipped_vehicles() {
  int loaded = 0;
  std::error_code code;
  for (const auto& entry : std::filesystem::directory_iterator("config/vehicles", code)) {
    if (auto vehicle = config::load<Vehicle>(entry.path()); !vehicle) {
      return {"shipped vehicles load", false, to_string(vehicle.error())};
    }
    ++loaded;
  }
  return {"shipped vehicles load", loaded > 0,
          loaded > 0 ? fmt::format("{} files in config/vehicles", loaded)
                     : "no config/vehicles here; run from the project's root"};
}

}  // namespace

int doctor_command(const CommonOptions& options) {
  const char* data = std::getenv("HEADLAND_DATA");
  const std::string data_directory = data != nullptr ? data : "../shared/data";
  std::vector<Check> checks{
      {"version", true,
       fmt::format("{} ({}, {})", HEADLAND_VERSION, HEADLAND_BUILD_TYPE, __VERSION__)},
      {"processors", std::thread::hardware_concurrency() > 0,
       fmt::format("{}", std::thread::hardware_concurrency())},
      check_writable("."),
      check_shipped_vehicles()};
  const bool data_here = std::filesystem::is_directory(data_directory);
  bool all_ok = true;
  for (const Check& check : checks) all_ok = all_ok && check.ok;

  if (options.json) {
    nlohmann::ordered_json document = {{"ok", all_ok}, {"checks", nlohmann::ordered_json::array()}};
    for (const Check& check : checks) {
      document["checks"].push_back(
          {{"name", check.name}, {"ok", check.ok}, {"detail", check.detail}});
    }
    document["data_directory"] = {{"path", data_directory}, {"present", data_here}};
    fmt::print("{}\n", document.dump(2));
  } else {
    for (const Check& check : checks) {
      fmt::print("{:4} {:32} {}\n", check.ok ? "ok" : "FAIL", check.name, check.detail);
    }
    fmt::print(
        "{:4} {:32} {}\n", data_here ? "ok" : "-", "public data sets (optional)",
        data_here ? data_directory : data_directory + " is absent; set HEADLAND_DATA to use them");
  }
  return all_ok ? 0 : 4;
}

}  // namespace headland::apps
