// SPDX-License-Identifier: Apache-2.0
#include "global_planner/roadmap/internal/roadmap_cache.hpp"

#include <cstring>
#include <fstream>
#include <iterator>
#include <string_view>
#include <system_error>
#include <type_traits>

#include <fmt/format.h>
#include <unistd.h>

#include "core/base/random.hpp"
#include "core/config/yaml.hpp"

namespace headland::internal {
namespace {

// Raised whenever the format, the sampling or the edges of the same inputs change.
constexpr std::uint64_t kVersion = 1;

// Numbers as they lie in memory: a cache stays on its machine.
class ByteWriter {
 public:
  template <class T>
  void put(T value) {
    static_assert(std::is_arithmetic_v<T>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(value));
  }
  void put(const Pose2& pose) {
    put(pose.x);
    put(pose.y);
    put(pose.yaw);
  }
  void put(const DriveCost& cost) {
    put(cost.length_m);
    put(cost.duration_s);
    put(cost.energy_j);
    put(cost.peak_j);
  }
  void put(const RoadEdge& edge) {
    put(edge.from);
    put(edge.to);
    put(static_cast<std::int8_t>((edge.open.forwards ? 1 : 0) + (edge.open.backwards ? 2 : 0)));
    put(static_cast<std::int8_t>(edge.track.count));
    for (int i = 0; i < edge.track.count; ++i) {
      const PathPiece& piece = edge.track.pieces[static_cast<std::size_t>(i)];
      put(piece.start);
      put(piece.curvature);
      put(piece.sharpness);
      put(piece.length);
    }
    put(edge.forwards);
    put(edge.backwards);
  }
  void put(std::string_view text) { bytes_.append(text); }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

// Reads nothing past the end; then everything is zero and ok() false.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  template <class T>
  T get() {
    T value{};
    if (bytes_.size() < sizeof(T)) {
      ok_ = false;
      bytes_ = {};
    } else {
      std::memcpy(&value, bytes_.data(), sizeof(T));
      bytes_.remove_prefix(sizeof(T));
    }
    return value;
  }
  Pose2 pose() {
    Pose2 pose;
    pose.x = get<double>();
    pose.y = get<double>();
    pose.yaw = get<double>();
    return pose;
  }
  DriveCost cost() {
    DriveCost cost;
    cost.length_m = get<double>();
    cost.duration_s = get<double>();
    cost.energy_j = get<double>();
    cost.peak_j = get<double>();
    return cost;
  }
  RoadEdge edge() {
    RoadEdge edge;
    edge.from = get<Heading>();
    edge.to = get<Heading>();
    const int open = get<std::int8_t>();
    edge.open = {(open & 1) != 0, (open & 2) != 0};
    edge.track.count = get<std::int8_t>();
    if (edge.track.count < 0 || edge.track.count > 3) {
      ok_ = false;
      edge.track.count = 0;
    }
    for (int i = 0; i < edge.track.count; ++i) {
      PathPiece& piece = edge.track.pieces[static_cast<std::size_t>(i)];
      piece.start = pose();
      piece.curvature = get<double>();
      piece.sharpness = get<double>();
      piece.length = get<double>();
    }
    edge.forwards = cost();
    edge.backwards = cost();
    return edge;
  }
  std::size_t left() const { return bytes_.size(); }
  bool ok() const { return ok_; }

 private:
  std::string_view bytes_;
  bool ok_ = true;
};

std::uint64_t key_of(const Region& drivable, const Ground& ground, const Vehicle& vehicle,
                     const RoadmapOptions& options) {
  ByteWriter all;
  all.put(kVersion);
  for (const Polygon& polygon : drivable.polygons()) {
    const auto put_ring = [&all](const Polyline& ring) {
      all.put(ring.size());
      for (const Point2& p : ring) all.put(Pose2{p.x(), p.y(), 0.0});
    };
    put_ring(polygon.outer);
    for (const Polyline& hole : polygon.holes) put_ring(hole);
  }
  all.put(ground.fingerprint());
  Vehicle copy = vehicle;
  config::Writer yaml;
  copy.visit(yaml);
  all.put(std::string_view(yaml.text()));
  all.put(options.seed);
  all.put(static_cast<int>(options.curve));
  all.put(options.margin_m);
  return fnv1a(all.bytes());
}

}  // namespace

RoadmapCache::RoadmapCache(const Region& drivable, const Ground& ground, const Vehicle& vehicle,
                           const RoadmapOptions& options) {
  if (options.cache.empty()) return;
  key_ = key_of(drivable, ground, vehicle, options);
  file_ = options.cache / fmt::format("{:016x}.roadmap", key_);
}

std::optional<RoadGraph> RoadmapCache::load() const {
  if (file_.empty()) return std::nullopt;
  std::ifstream stream(file_, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (bytes.size() < sizeof(std::uint64_t)) return std::nullopt;
  const std::string_view content(bytes.data(), bytes.size() - sizeof(std::uint64_t));
  ByteReader checksum({bytes.data() + content.size(), sizeof(std::uint64_t)});
  if (checksum.get<std::uint64_t>() != fnv1a(content)) return std::nullopt;

  ByteReader reader(content);
  if (reader.get<std::uint64_t>() != key_) return std::nullopt;
  RoadGraph graph;
  graph.samples = reader.get<int>();
  graph.draws = reader.get<std::int64_t>();
  const auto nodes = reader.get<std::uint64_t>();
  const auto edges = reader.get<std::uint64_t>();
  for (std::uint64_t i = 0; i < nodes && reader.ok(); ++i) graph.nodes.push_back(reader.pose());
  for (std::uint64_t i = 0; i < edges && reader.ok(); ++i) graph.edges.push_back(reader.edge());
  if (!reader.ok() || reader.left() > 0) return std::nullopt;
  return graph;
}

void RoadmapCache::store(const RoadGraph& graph) const {
  if (file_.empty()) return;
  ByteWriter content;
  content.put(key_);
  content.put(graph.samples);
  content.put(graph.draws);
  content.put(static_cast<std::uint64_t>(graph.nodes.size()));
  content.put(static_cast<std::uint64_t>(graph.edges.size()));
  for (const Pose2& node : graph.nodes) content.put(node);
  for (const RoadEdge& edge : graph.edges) content.put(edge);
  content.put(fnv1a(content.bytes()));

  std::error_code ignored;
  std::filesystem::create_directories(file_.parent_path(), ignored);
  const std::filesystem::path beside = file_.string() + fmt::format(".{}", ::getpid());
  std::ofstream stream(beside, std::ios::binary);
  stream.write(content.bytes().data(), static_cast<std::streamsize>(content.bytes().size()));
  stream.close();
  if (stream.good()) std::filesystem::rename(beside, file_, ignored);
  if (!stream.good() || ignored) std::filesystem::remove(beside, ignored);
}

}  // namespace headland::internal
