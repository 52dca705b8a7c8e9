// SPDX-License-Identifier: Apache-2.0
#include "sim/lidar/camera.hpp"

#include <algorithm>
#include <cmath>

#include "sim/lidar/internal/agent_bodies.hpp"

namespace headland {
namespace {

constexpr int kLooksUp = 4;         // rays that look for an agent: by height,
constexpr int kLooksAcross = 3;     // and across
constexpr double kSoftness = 0.25;  // of the loss of small boxes, over found_half_px

ObjectClass class_of(AgentKind kind) {
  switch (kind) {
    case AgentKind::kPerson:
      return ObjectClass::kPerson;
    case AgentKind::kVehicle:
      return ObjectClass::kVehicle;
    default:
      return ObjectClass::kLivestock;
  }
}

CameraModel model_of(const CameraConfig& config, const SensorMount& mount) {
  const double focal = 0.5 * config.width_px / std::tan(0.5 * deg_to_rad(config.view_deg));
  Eigen::Matrix3d intrinsics;
  intrinsics << focal, 0.0, 0.5 * config.width_px, 0.0, focal, 0.5 * config.height_px, 0.0, 0.0,
      1.0;
  Eigen::Matrix3d R_camera_sensor;  // to the right, down, ahead
  R_camera_sensor << 0.0, -1.0, 0.0, 0.0, 0.0, -1.0, 1.0, 0.0, 0.0;
  CameraModel model{config.width_px, config.height_px, {}};
  model.projection = intrinsics * R_camera_sensor * mount.pose().inverse().matrix().topRows<3>();
  return model;
}

ImageBox clipped(const ImageBox& box, const CameraModel& model) {
  return {std::max(box.left, 0.0), std::max(box.top, 0.0),
          std::min(box.right, static_cast<double>(model.width_px)),
          std::min(box.bottom, static_cast<double>(model.height_px))};
}

}  // namespace

std::optional<ImageBox> box_of(const CameraModel& model, const Agent& agent, double ground_m,
                               const Eigen::Isometry3d& T_map_base) {
  const Eigen::Isometry3d T_base_map = T_map_base.inverse();
  std::optional<ImageBox> box;
  for (const internal::Body& body : internal::bodies_of(agent, 0)) {
    for (const Eigen::Vector3d& end : {body.a, body.b}) {
      for (int corner = 0; corner < 8; ++corner) {
        const Eigen::Vector3d side(corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0,
                                   corner & 4 ? 1.0 : -1.0);
        // Of the cube in the ball rather than around it, so that the box is not too large.
        Eigen::Vector3d p_map = end + body.radius * 0.8 * side;
        p_map.z() = std::max(0.0, p_map.z()) + ground_m;
        const std::optional<Eigen::Vector2d> pixel = model.pixel(T_base_map * p_map);
        if (!pixel) return std::nullopt;
        if (!box) box = ImageBox{pixel->x(), pixel->y(), pixel->x(), pixel->y()};
        box->left = std::min(box->left, pixel->x());
        box->right = std::max(box->right, pixel->x());
        box->top = std::min(box->top, pixel->y());
        box->bottom = std::max(box->bottom, pixel->y());
      }
    }
  }
  return box;
}

CameraSimulator::CameraSimulator(const CameraConfig& config, const SensorMount& mount,
                                 std::uint64_t seed)
    : config_(config),
      model_(model_of(config, mount)),
      T_base_sensor_(mount.pose()),
      finding_(seed, "sim/camera/finding"),
      boxes_(seed, "sim/camera/boxes"),
      false_(seed, "sim/camera/false") {}

void CameraSimulator::detect(const LidarScene& scene, const Eigen::Isometry3d& T_map_base,
                             std::vector<DetectedBox>& out) {
  out.clear();
  truth_.clear();
  if (!T_map_base.matrix().allFinite()) return;
  for (std::size_t i = 0; i < scene.agents().size(); ++i) {
    const Agent& agent = scene.agents()[i];
    const double ground = scene.ground(agent.position).height;
    const std::optional<ImageBox> whole = box_of(model_, agent, ground, T_map_base);
    if (!whole) continue;
    const ImageBox box = clipped(*whole, model_);
    if (box.area() <= 0.0) continue;
    const double on_image = box.area() / whole->area();
    const double visible = on_image * visible_ratio(scene, static_cast<int>(i), T_map_base);
    const double least = config_.least_visible_ratio;
    const double open = std::clamp((visible - least) / (1.0 - least), 0.0, 1.0);
    const double half = config_.found_half_px;
    const double height = box.bottom - box.top;
    const double large =
        half > 0.0 ? 1.0 / (1.0 + std::exp((half - height) / (kSoftness * half))) : 1.0;
    // Half of what is hidden does not hurt.
    const double found = config_.found_probability * large * std::min(1.0, 2.0 * open);
    if (finding_.uniform() >= found) continue;
    out.push_back(seen(box, class_of(agent.kind)));
    truth_.push_back(static_cast<int>(i));
  }
  add_false_boxes(out);
}

// Share of the agent that nothing hides, by a few rays; leaves hide as their density says.
double CameraSimulator::visible_ratio(const LidarScene& scene, int agent,
                                      const Eigen::Isometry3d& T_map_base) {
  const Agent& who = scene.agents()[static_cast<std::size_t>(agent)];
  const Eigen::Vector3d eye = (T_map_base * T_base_sensor_).translation();
  const double height = internal::height_of(who);
  const double ground = scene.ground(who.position).height;
  const Point2 way = who.position - eye.head<2>();
  const Point2 across = Point2(-way.y(), way.x()).normalized();
  const double reach =
      who.kind == AgentKind::kPerson ? 0.7 * std::min(0.25, who.radius_m) : 0.5 * who.radius_m;
  int open = 0;
  for (int i = 0; i < kLooksUp; ++i) {
    for (int j = 0; j < kLooksAcross; ++j) {
      const Point2 p = who.position + (j - 0.5 * (kLooksAcross - 1)) * reach * across;
      const Eigen::Vector3d target(p.x(), p.y(), ground + height * (i + 0.5) / kLooksUp);
      Ray ray;
      ray.origin = eye;
      ray.direction = (target - eye).normalized();
      // Up to the body, which a ray beside the legs may miss.
      ray.max_range = std::max(0.0, (target - eye).norm() - 0.05);
      ray.depth = -std::log(1.0 - finding_.uniform());
      const RayHit hit = scene.trace(ray);
      if (hit.surface == Surface::kNone || hit.agent == agent) ++open;
    }
  }
  return static_cast<double>(open) / (kLooksUp * kLooksAcross);
}

DetectedBox CameraSimulator::seen(const ImageBox& box, ObjectClass kind) {
  const double across = config_.jitter_ratio * (box.right - box.left);
  const double up = config_.jitter_ratio * (box.bottom - box.top);
  ImageBox moved{box.left + across * boxes_.normal(), box.top + up * boxes_.normal(),
                 box.right + across * boxes_.normal(), box.bottom + up * boxes_.normal()};
  if (moved.area() <= 0.0) moved = box;
  auto label = static_cast<int>(kind);
  const bool confused = boxes_.uniform() < config_.confusion_probability;
  const int other = 1 + boxes_.index(kObjectClasses - 1);
  if (confused) label = (label + other) % kObjectClasses;
  DetectedBox detected{clipped(moved, model_), boxes_.uniform(0.5, 1.0), {}};
  const double sure = confused ? boxes_.uniform(0.4, 0.7) : boxes_.uniform(0.6, 0.95);
  detected.probability.fill((1.0 - sure) / (kObjectClasses - 1));
  detected.probability[static_cast<std::size_t>(label)] = sure;
  return detected;
}

void CameraSimulator::add_false_boxes(std::vector<DetectedBox>& out) {
  // Knuth: as many as uniform numbers can be multiplied before exp(-mean) is passed.
  const double limit = std::exp(-config_.false_per_image_ratio);
  for (double product = false_.uniform(); product > limit; product *= false_.uniform()) {
    const double height = false_.uniform(0.05, 0.4) * model_.height_px;
    const double width = height * false_.uniform(0.3, 1.5);
    const double left = false_.uniform(-0.5 * width, model_.width_px - 0.5 * width);
    const double bottom = false_.uniform(0.5, 1.0) * model_.height_px;
    DetectedBox box;
    box.box = clipped({left, bottom - height, left + width, bottom}, model_);
    box.score = false_.uniform(0.3, 0.7);
    const double sure = false_.uniform(0.3, 0.7);
    box.probability.fill((1.0 - sure) / (kObjectClasses - 1));
    box.probability[static_cast<std::size_t>(false_.index(kObjectClasses))] = sure;
    out.push_back(box);
    truth_.push_back(-1);
  }
}

}  // namespace headland
