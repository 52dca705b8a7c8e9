// SPDX-License-Identifier: Apache-2.0
#include "sim/crowd/tracks.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <string_view>

#include <fmt/format.h>

namespace headland {
namespace {

double radius_of(AgentKind kind) {
  switch (kind) {
    case AgentKind::kSheep:
      return 0.4;
    case AgentKind::kCattle:
      return 0.9;
    case AgentKind::kVehicle:
      return 1.5;
    default:
      return 0.3;
  }
}

// The fields of a line, without what surrounds them.
std::vector<std::string_view> split(std::string_view line, std::string_view separators) {
  std::vector<std::string_view> fields;
  for (std::size_t begin = line.find_first_not_of(separators); begin != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(separators, begin), line.size());
    fields.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(separators, end);
  }
  return fields;
}

std::optional<double> number(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole && std::isfinite(value) ? std::optional<double>(value) : std::nullopt;
}

std::optional<int> integer(std::string_view text) {
  const auto value = number(text);
  if (!value || *value != std::floor(*value) || std::abs(*value) > 1e9) return std::nullopt;
  return static_cast<int>(*value);
}

using Fields = std::vector<std::string_view>;

// Gives each line that is not empty to `take`, which says what is wrong with it, if anything.
std::optional<Error> for_each_line(
    const std::string& file, std::string_view separators,
    const std::function<std::optional<std::string>(const Fields&)>& take) {
  std::ifstream in(file);
  if (!in) return Error{ErrorCode::kFileNotFound, "cannot be read", "name a file", {file, 0, {}}};
  std::string line;
  for (int count = 1; std::getline(in, line); ++count) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    const Fields fields = split(line, separators);
    if (fields.empty()) continue;
    if (auto wrong = take(fields)) {
      return Error{ErrorCode::kSyntax, *wrong, "see sim/crowd/tracks.hpp", {file, count, {}}};
    }
  }
  return std::nullopt;
}

Track& track_of(TrackSet& set, int id) {
  const auto found = std::find_if(set.tracks.begin(), set.tracks.end(),
                                  [id](const Track& track) { return track.id == id; });
  if (found != set.tracks.end()) return *found;
  set.tracks.push_back({id, AgentKind::kPerson, {}, {}});
  return set.tracks.back();
}

// Puts the samples of a track in order of time. False if there are two of the same time.
bool sort_by_time(Track& track) {
  std::vector<std::pair<double, Point2>> samples;
  for (std::size_t i = 0; i < track.time_s.size(); ++i) {
    samples.emplace_back(track.time_s[i], track.position[i]);
  }
  const auto earlier = [](const auto& a, const auto& b) { return a.first < b.first; };
  std::sort(samples.begin(), samples.end(), earlier);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    track.time_s[i] = samples[i].first;
    track.position[i] = samples[i].second;
    if (i > 0 && !(track.time_s[i - 1] < track.time_s[i])) return false;
  }
  return true;
}

// Puts tracks in order, and their clock to 0 at the first sample; finds the step.
std::optional<std::string> finish(TrackSet& set) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  double begin = kNever;
  set.step_s = kNever;
  for (Track& track : set.tracks) {
    if (!sort_by_time(track)) return fmt::format("{} has two samples of one time", track.id);
    begin = std::min(begin, track.time_s.front());
    for (std::size_t i = 1; i < track.time_s.size(); ++i) {
      set.step_s = std::min(set.step_s, track.time_s[i] - track.time_s[i - 1]);
    }
  }
  if (!std::isfinite(set.step_s)) return "no track has two samples";
  set.step_s = std::round(set.step_s * 1e6) / 1e6;
  for (Track& track : set.tracks) {
    for (double& time : track.time_s) time -= begin;
  }
  return std::nullopt;
}

std::optional<AgentKind> kind_of(std::string_view role) {
  if (role == "sheep") return AgentKind::kSheep;
  if (role == "dog") return AgentKind::kDog;
  if (role == "shepherd") return AgentKind::kPerson;
  return std::nullopt;
}

}  // namespace

std::optional<Agent> Track::at(double time) const {
  if (!(time >= time_s.front() && time <= time_s.back())) return std::nullopt;
  Agent agent{id, kind, position.front(), {0.0, 0.0}, radius_of(kind)};
  if (time_s.size() == 1) return agent;
  const auto next = std::lower_bound(time_s.begin() + 1, time_s.end(), time);
  const auto i = static_cast<std::size_t>(next - time_s.begin());
  agent.velocity = (position[i] - position[i - 1]) / (time_s[i] - time_s[i - 1]);
  agent.position = position[i] - (time_s[i] - time) * agent.velocity;
  return agent;
}

double TrackSet::end_s() const {
  double end = 0.0;
  for (const Track& track : tracks) end = std::max(end, track.time_s.back());
  return end;
}

void TrackSet::at(double time_s, std::vector<Agent>& agents) const {
  agents.clear();
  for (const Track& track : tracks) {
    if (const auto agent = track.at(time_s)) agents.push_back(*agent);
  }
}

Result<TrackSet> read_obsmat(const std::string& file) {
  TrackSet set{file, 0.0, {}};
  const auto take = [&set](const Fields& fields) -> std::optional<std::string> {
    if (fields.size() != 8 && fields.size() != 4) {
      return fmt::format("{} columns, not 8 or 4", fields.size());
    }
    const auto frame = number(fields[0]);
    const auto id = integer(fields[1]);
    const auto x = number(fields[2]);
    const auto y = number(fields.size() == 8 ? fields[4] : fields[3]);
    if (!frame || !id || !x || !y) return "a frame, id, x or y that is no number";
    Track& track = track_of(set, *id);
    track.time_s.push_back(*frame);
    track.position.emplace_back(*x, *y);
    return std::nullopt;
  };
  if (auto error = for_each_line(file, " \t", take)) return tl::unexpected<Error>(*error);
  if (const auto wrong = finish(set)) return fail(ErrorCode::kSyntax, *wrong, {}, {file, 0, {}});
  constexpr double kStep = 0.4;  // [s]
  for (Track& track : set.tracks) {
    for (double& time : track.time_s) time *= kStep / set.step_s;
  }
  set.step_s = kStep;
  return set;
}

Result<std::vector<TrackSet>> read_sheep_dog(const std::string& file) {
  std::vector<TrackSet> drives;
  bool header = true;
  const auto take = [&](const Fields& fields) -> std::optional<std::string> {
    if (fields.size() != 7) return fmt::format("{} columns, not 7", fields.size());
    if (std::exchange(header, false)) return std::nullopt;
    const auto time = number(fields[2]);
    const auto id = integer(fields[3]);
    const auto kind = kind_of(fields[4]);
    const auto x = number(fields[5]);
    const auto y = number(fields[6]);
    if (!time || !id || !x || !y) return "a time, agent, x or y that is no number";
    if (!kind) return fmt::format("role \"{}\", not sheep, dog or shepherd", fields[4]);
    const std::string name = fmt::format("{}/{}", fields[0], fields[1]);
    if (drives.empty() || drives.back().name != name) drives.push_back({name, 0.0, {}});
    Track& track = track_of(drives.back(), *id);
    track.kind = *kind;
    track.time_s.push_back(*time);
    track.position.emplace_back(*x, *y);
    return std::nullopt;
  };
  if (auto error = for_each_line(file, ",", take)) return tl::unexpected<Error>(*error);
  if (drives.empty()) return fail(ErrorCode::kSyntax, "no tracks", {}, {file, 0, {}});
  for (TrackSet& drive : drives) {
    if (const auto wrong = finish(drive)) {
      return fail(ErrorCode::kSyntax, fmt::format("drive {}: {}", drive.name, *wrong), {},
                  {file, 0, {}});
    }
  }
  return drives;
}

}  // namespace headland
