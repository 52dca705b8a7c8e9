// SPDX-License-Identifier: Apache-2.0
// Perception beside PCL and OctoMap on real scans: ./build/bench/perception_bench
// Scans are read from ../shared/data/lidar (or $HEADLAND_DATA/lidar); without them nothing runs.
#include <cstdlib>
#include <filesystem>
#include <string>

#include <benchmark/benchmark.h>
#include <octomap/OcTree.h>

#include "perception/cloud/cloud.hpp"
#include "perception/cloud/cloud_file.hpp"
#include "perception/cloud/voxel_thinning.hpp"
#include "perception/ground/clusters.hpp"
#include "perception/ground/ground_plane.hpp"
#include "perception/ground/height_grid.hpp"
#include "perception/mapping/rolling_grid.hpp"
#ifdef BENCH_PCL
#include <pcl/filters/voxel_grid.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>
#include <pcl/segmentation/sac_segmentation.h>
#endif

namespace headland {
namespace {

using Points = std::vector<LidarPoint>;

// A scan in base, its points that are no ground, and these with one point per 0.1 m.
struct Scene {
  Points all;
  Points objects;
  Points voxels;
  double sensor_height = 0.0;  // [m]
};

Points thinned(const Points& points, double voxel) {
  Points out;
  VoxelThinning(voxel).thin(points, out);
  return out;
}

Scene load(const std::filesystem::path& file, double mount_height, double sensor_height) {
  Scene scene;
  const auto scan = load_cloud(file);
  if (!scan) return scene;
  SensorMount mount;
  mount.z_m = mount_height;
  CropConfig crop;
  crop.far_m = 300.0;
  crop.low_m = -20.0;
  crop.high_m = 50.0;
  crop_to_base(scan->points, mount.pose(), crop, scene.all);
  HeightGrid ground;
  ground.update(scene.all, {0.0, 0.0});
  for (std::size_t i = 0; i < scene.all.size(); ++i) {
    if (ground.labels()[i] != GroundLabel::kGround) scene.objects.push_back(scene.all[i]);
  }
  scene.voxels = thinned(scene.objects, 0.1);
  scene.sensor_height = sensor_height;
  return scene;
}

void count_points(benchmark::State& state, const Points& points) {
  state.counters["points"] = static_cast<double>(points.size());
}

void plane(benchmark::State& state, const Scene& scene) {
  GroundPlaneConfig config;
  config.sensor_height_m = scene.sensor_height;
  GroundPlane found;
  for (auto _ : state) found = fit_ground_plane(scene.all, config);
  count_points(state, scene.all);
  state.counters["normal_z"] = found.normal.z();
}

void heights(benchmark::State& state, const Scene& scene) {
  HeightGrid grid;
  for (auto _ : state) grid.update(scene.all, {0.0, 0.0});
  count_points(state, scene.all);
}

void thinning(benchmark::State& state, const Points& points) {
  VoxelThinning thinner(0.1);
  Points out;
  for (auto _ : state) thinner.thin(points, out);
  count_points(state, points);
  state.counters["kept"] = static_cast<double>(out.size());
}

void clusters(benchmark::State& state, const Points& points) {
  ClusterFinder finder;
  std::size_t found = 0;
  for (auto _ : state) found = finder.find(points).size();
  count_points(state, points);
  state.counters["found"] = static_cast<double>(found);
}

Points every_fourth(const Points& points) {
  Points kept;
  for (std::size_t i = 0; i < points.size(); i += 4) kept.push_back(points[i]);
  return kept;
}

void grid(benchmark::State& state, const Scene& scene, double cell) {
  const Points points = every_fourth(scene.all);
  RollingGridConfig config;
  config.cell_m = cell;
  RollingGrid occupancy(config);
  for (auto _ : state) occupancy.insert(points, {0.0, 0.0, scene.sensor_height}, 0.0);
  count_points(state, points);
}

void octomap_insert(benchmark::State& state, const Scene& scene, double cell) {
  octomap::Pointcloud cloud;
  const Points points = every_fourth(scene.all);
  for (const LidarPoint& point : points) {
    cloud.push_back(point.position.x(), point.position.y(), point.position.z());
  }
  octomap::OcTree tree(cell);
  const octomap::point3d origin(0.0f, 0.0f, static_cast<float>(scene.sensor_height));
  for (auto _ : state) tree.insertPointCloud(cloud, origin, 40.0);
  count_points(state, points);
}

#ifdef BENCH_PCL
using Cloud = pcl::PointCloud<pcl::PointXYZ>;

Cloud::Ptr to_pcl(const Points& points) {
  auto cloud = pcl::make_shared<Cloud>();
  for (const LidarPoint& point : points) {
    cloud->emplace_back(point.position.x(), point.position.y(), point.position.z());
  }
  return cloud;
}

// `upright`: with the axis and tolerance that ours has, else without, as most use it.
void pcl_plane(benchmark::State& state, const Scene& scene, bool upright) {
  const Cloud::Ptr cloud = to_pcl(scene.all);
  pcl::ModelCoefficients plane;
  pcl::PointIndices inliers;
  for (auto _ : state) {
    pcl::SACSegmentation<pcl::PointXYZ> search;
    search.setModelType(upright ? pcl::SACMODEL_PERPENDICULAR_PLANE : pcl::SACMODEL_PLANE);
    if (upright) search.setAxis(Eigen::Vector3f::UnitZ());
    if (upright) search.setEpsAngle(0.26);
    search.setMethodType(pcl::SAC_RANSAC);
    search.setDistanceThreshold(0.2);
    search.setMaxIterations(100);
    search.setInputCloud(cloud);
    search.segment(inliers, plane);
  }
  count_points(state, scene.all);
  state.counters["normal_z"] = plane.values.size() == 4 ? std::abs(plane.values[2]) : 0.0;
}

void pcl_thinning(benchmark::State& state, const Points& points) {
  const Cloud::Ptr cloud = to_pcl(points);
  Cloud out;
  for (auto _ : state) {
    pcl::VoxelGrid<pcl::PointXYZ> filter;
    filter.setLeafSize(0.1f, 0.1f, 0.1f);
    filter.setInputCloud(cloud);
    filter.filter(out);
  }
  count_points(state, points);
  state.counters["kept"] = static_cast<double>(out.size());
}

void pcl_clusters(benchmark::State& state, const Points& points) {
  const Cloud::Ptr cloud = to_pcl(points);
  std::vector<pcl::PointIndices> found;
  for (auto _ : state) {
    auto tree = pcl::make_shared<pcl::search::KdTree<pcl::PointXYZ>>();
    tree->setInputCloud(cloud);
    pcl::EuclideanClusterExtraction<pcl::PointXYZ> search;
    search.setClusterTolerance(0.5);
    search.setMinClusterSize(5);
    search.setSearchMethod(tree);
    search.setInputCloud(cloud);
    found.clear();
    search.extract(found);
  }
  count_points(state, points);
  state.counters["found"] = static_cast<double>(found.size());
}
#endif

template <class Run>
void add(const std::string& name, Run run) {
  benchmark::RegisterBenchmark(name.c_str(), run)->Unit(benchmark::kMillisecond);
}

// `scene` must outlive the run.
void add_scene(const std::string& name, const Scene& scene) {
  using benchmark::State;
  add(name + "/plane/ours", [&](State& s) { plane(s, scene); });
  add(name + "/heights/ours", [&](State& s) { heights(s, scene); });
  add(name + "/thinning/ours", [&](State& s) { thinning(s, scene.objects); });
  add(name + "/clusters_of_points/ours", [&](State& s) { clusters(s, scene.objects); });
  add(name + "/clusters_of_all_points/ours", [&](State& s) { clusters(s, scene.all); });
  add(name + "/clusters_of_voxels/ours", [&](State& s) { clusters(s, scene.voxels); });
#ifdef BENCH_PCL
  add(name + "/plane/pcl_plain", [&](State& s) { pcl_plane(s, scene, false); });
  add(name + "/plane/pcl_perpendicular", [&](State& s) { pcl_plane(s, scene, true); });
  add(name + "/thinning/pcl", [&](State& s) { pcl_thinning(s, scene.objects); });
  add(name + "/clusters_of_voxels/pcl", [&](State& s) { pcl_clusters(s, scene.voxels); });
#endif
  for (const double cell : {0.1, 0.2}) {
    const std::string grid_name = name + (cell < 0.15 ? "/occupancy_0.1" : "/occupancy_0.2");
    add(grid_name + "/ours", [&, cell](State& s) { grid(s, scene, cell); });
    add(grid_name + "/octomap", [&, cell](State& s) { octomap_insert(s, scene, cell); });
  }
}

}  // namespace
}  // namespace headland

int main(int argc, char** argv) {
  const char* data = std::getenv("HEADLAND_DATA");
  const auto folder = std::filesystem::path(data != nullptr ? data : "../shared/data") / "lidar";
  const headland::Scene kitti =
      headland::load(folder / "kitti_000000/velodyne_000000.bin", 1.73, 1.73);
  const headland::Scene ring128 = headland::load(folder / "ring128/000000.pcd", 0.1, 1.8);
  const headland::Scene pair = headland::load(folder / "scan_pair/source.ply", 1.9, 1.9);
  if (!kitti.all.empty()) headland::add_scene("kitti", kitti);
  if (!ring128.all.empty()) headland::add_scene("ring128", ring128);
  if (!pair.all.empty()) headland::add_scene("scan_pair", pair);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
