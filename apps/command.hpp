// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/base/result.hpp"
#include "core/config/yaml.hpp"

namespace headland::apps {

/// Options that every sub-command takes.
struct CommonOptions {
  std::string file;              ///< the mission, study, ... named on the command line
  std::string out = "out";       ///< directory for all files
  bool json = false;             ///< one JSON document on stdout, nothing else there
  std::vector<std::string> set;  ///< key=value overrides
};

/// Runs a sub-command; returns the exit code.
int plan_command(const CommonOptions& options);
int run_command(const CommonOptions& options, double realtime);
int study_command(const CommonOptions& options, int jobs, int max_episodes);
int perceive_command(const CommonOptions& options);
int doctor_command(const CommonOptions& options);

struct RouteOptions {
  double time_limit_s = 60.0;
  std::uint64_t seed = 1;
  long iterations = 0;  ///< rounds of one search; 0: searches until the time or ideas run out
};
int route_command(const CommonOptions& common, const RouteOptions& options);

/// Prints the error as one line on stderr (and as JSON on stdout with --json); returns its exit
/// code.
int report_error(const Error& error, const CommonOptions& options);

/// Reads a YAML file and applies the `--set` overrides.
Result<config::Node> load_with_overrides(const CommonOptions& options);
/// The `--set` overrides alone, for commands whose file is no YAML.
Result<config::Node> overrides_only(const CommonOptions& options);

/// The configuration that was used, as text and as a hash.
struct Stamp {
  std::string version;
  std::uint64_t seed = 0;
  std::string config_yaml;
  std::string config_hash;
};
Stamp make_stamp(std::uint64_t seed, std::string config_yaml);

/// A progress bar on stderr, only where that is a terminal.
class ProgressBar {
 public:
  explicit ProgressBar(std::string label);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  /// `note`: a few words behind the bar.
  void update(double fraction, const std::string& note = {});

 private:
  std::string label_;
  bool terminal_;
  int shown_percent_ = -1;
  std::string shown_note_;
};

/// `text` in bold or a colour, where stderr is a terminal and NO_COLOR is not set.
std::string styled(const std::string& text, const char* ansi_code);

}  // namespace headland::apps
