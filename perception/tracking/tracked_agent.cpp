// SPDX-License-Identifier: Apache-2.0
#include "perception/tracking/tracked_agent.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace headland {
namespace {

constexpr double kCattleHeight = 1.1;  // [m]; sheep are lower
constexpr double kLeastRadius = 0.25;  // of an agent [m]
constexpr double kEven = 1.0 / kObjectClasses;

double probability_of(const ClassProbability& probability, ObjectClass object) {
  return probability[static_cast<std::size_t>(object)];
}

AgentKind kind_of(const TrackedAgent& track) {
  switch (most_probable(track.probability)) {
    case ObjectClass::kLivestock:
      return track.height_m > kCattleHeight ? AgentKind::kCattle : AgentKind::kSheep;
    case ObjectClass::kVehicle:
      return AgentKind::kVehicle;
    case ObjectClass::kPerson:
    case ObjectClass::kOther:
      break;
  }
  return AgentKind::kPerson;
}

}  // namespace

double MotionConfig::variance(const ClassProbability& probability) const {
  return probability_of(probability, ObjectClass::kPerson) * person_mps * person_mps +
         probability_of(probability, ObjectClass::kLivestock) * livestock_mps * livestock_mps +
         probability_of(probability, ObjectClass::kVehicle) * vehicle_mps * vehicle_mps +
         probability_of(probability, ObjectClass::kOther) * other_mps * other_mps;
}

TrackedAgent begin_track(const Detection& detection, const MotionConfig& config, int id,
                         double time_s) {
  TrackedAgent track;
  track.id = id;
  track.state << detection.position, 0.0, 0.0;
  track.covariance.setZero();
  track.covariance.topLeftCorner<2, 2>() = detection.covariance;
  track.covariance.bottomRightCorner<2, 2>() =
      config.first_speed_mps * config.first_speed_mps * Eigen::Matrix2d::Identity();
  track.width_m = detection.across_m;
  track.height_m = detection.height_m;
  track.probability = fuse(kUnknownClass, detection.probability);
  track.first_s = time_s;
  track.last_s = time_s;
  return track;
}

void predict(TrackedAgent& track, double dt, const MotionConfig& config) {
  Eigen::Matrix4d transition = Eigen::Matrix4d::Identity();
  transition.topRightCorner<2, 2>() = dt * Eigen::Matrix2d::Identity();
  const double q = config.variance(track.probability);
  track.state = transition * track.state;
  track.covariance = transition * track.covariance * transition.transpose();
  for (int axis = 0; axis < 2; ++axis) {
    track.covariance(axis, axis) += q * dt * dt * dt / 3.0;
    track.covariance(axis, axis + 2) += q * dt * dt / 2.0;
    track.covariance(axis + 2, axis) += q * dt * dt / 2.0;
    track.covariance(axis + 2, axis + 2) += q * dt;
  }
}

void correct(TrackedAgent& track, const Detection& detection) {
  const Eigen::Matrix2d s = track.position_covariance() + detection.covariance;
  const Eigen::Matrix<double, 4, 2> gain = track.covariance.leftCols<2>() * s.inverse();
  track.state += gain * (detection.position - track.position());
  Eigen::Matrix4d kept = Eigen::Matrix4d::Identity();
  kept.leftCols<2>() -= gain;
  track.covariance =
      kept * track.covariance * kept.transpose() + gain * detection.covariance * gain.transpose();
}

Fit fit_of(const TrackedAgent& track, const Detection& detection) {
  const Eigen::Matrix2d s = track.position_covariance() + detection.covariance;
  const Point2 error = detection.position - track.position();
  return {error.dot(s.inverse() * error), std::log(s.determinant())};
}

ClassProbability fuse(const ClassProbability& prior, const ClassProbability& evidence,
                      double weight, double floor) {
  double given = 0.0;
  for (const double p : evidence) {
    if (!(p >= 0.0) || !std::isfinite(p)) return prior;
    given += p;
  }
  if (!(given > 0.0) || !(weight > 0.0)) return prior;
  ClassProbability posterior{};
  double sum = 0.0;
  for (std::size_t i = 0; i < posterior.size(); ++i) {
    const double odds = std::max(evidence[i] / given, 1e-6) / kEven;
    posterior[i] = prior[i] * std::pow(odds, weight);
    sum += posterior[i];
  }
  if (!(sum > 0.0) || !std::isfinite(sum)) return prior;
  double raised = 0.0;
  for (double& p : posterior) raised += p = std::max(p / sum, floor);
  for (double& p : posterior) p /= raised;
  return posterior;
}

ObjectClass most_probable(const ClassProbability& probability) {
  const auto most = std::max_element(probability.begin(), probability.end());
  if (!(*most > kEven + 1e-9)) return ObjectClass::kOther;
  return static_cast<ObjectClass>(most - probability.begin());
}

Agent to_agent(const TrackedAgent& track) {
  Agent agent;
  agent.id = track.id;
  agent.kind = kind_of(track);
  agent.position = track.position();
  agent.velocity = track.velocity();
  agent.radius_m = std::max(track.radius(), kLeastRadius);
  agent.noise_m = std::sqrt(0.5 * track.position_covariance().trace());
  return agent;
}

}  // namespace headland
