// SPDX-License-Identifier: Apache-2.0
// A ray through the blocks of a world, after Amanatides and Woo 1987.
#include <algorithm>
#include <cmath>

#include "sim/lidar/internal/world.hpp"

namespace headland::internal {
namespace {

// Longest step through leaves [m]: across a block, one for each voxel.
constexpr double kMarch = World::kVoxel;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Optical depth per metre of a voxel by its stored density.
constexpr double kRate = kLeafProjection * World::kDensityStep;

// Walk of a line along one axis of a grid: when it next crosses, and into which cell.
struct Walk {
  double next = kInfinity;
  double period = kInfinity;
  int step = 0;

  // `place`: where the line is at time `t`, in cells; `speed`: cells per unit of time.
  Walk(double place, int cell, double speed, double t) {
    if (speed > 0.0) {
      step = 1;
      period = 1.0 / speed;
      next = t + (cell + 1 - place) * period;
    } else if (speed < 0.0) {
      step = -1;
      period = -1.0 / speed;
      next = t + (place - cell) * period;
    }
  }
  void advance(int& cell) {
    cell += step;
    next += period;
  }
};

struct Contact {
  double t = kInfinity;
  double cosine = 1.0;
};

// First contact of the line with a capsule from outside, at t >= 0.
Contact meet(const Eigen::Vector3d& start, const Eigen::Vector3d& step, const Body& body,
             double radius) {
  const Eigen::Vector3d axis = body.b - body.a;
  const Eigen::Vector3d from_a = start - body.a;
  const double axis2 = axis.squaredNorm();
  const double step2 = step.squaredNorm();
  const double along = axis.dot(step);
  const double offset = axis.dot(from_a);
  const double a = axis2 * step2 - along * along;
  const double b = axis2 * step.dot(from_a) - offset * along;
  const double c = axis2 * (from_a.squaredNorm() - radius * radius) - offset * offset;
  const auto contact = [&](double t, double share) {
    const Eigen::Vector3d outward = start + t * step - (body.a + share * axis);
    return Contact{t, std::abs(outward.dot(step)) / (radius * std::sqrt(step2))};
  };
  double y = along > 0.0 ? -1.0 : 2.0 * axis2;  // which cap a parallel line meets
  if (a > 1e-12 * axis2 * step2) {
    const double d = b * b - a * c;
    if (d < 0.0) return {};
    const double t = (-b - std::sqrt(d)) / a;
    y = offset + t * along;
    if (y > 0.0 && y < axis2) return t >= 0.0 ? contact(t, y / axis2) : Contact{};
  }
  const double share = y <= 0.0 ? 0.0 : 1.0;
  const Eigen::Vector3d from_cap = from_a - share * axis;
  const double half = step.dot(from_cap);
  const double d = half * half - step2 * (from_cap.squaredNorm() - radius * radius);
  if (d < 0.0) return {};
  const double t = (-half - std::sqrt(d)) / step2;
  return t >= 0.0 ? contact(t, share) : Contact{};
}

// Whether the capsule may touch a piece whose heights lie within [low, high] and whose way in the
// plane is a line through (x, y) along the unit vector `along`: a cheap bound for most bodies.
bool near(const Body& body, double low, double high, const Point2& start, const Point2& along,
          double radius) {
  if (std::min(body.a.z(), body.b.z()) - radius > high) return false;
  if (std::max(body.a.z(), body.b.z()) + radius < low) return false;
  const Point2 a = body.a.head<2>() - start;
  const Point2 b = body.b.head<2>() - start;
  const double side_a = along.x() * a.y() - along.y() * a.x();
  const double side_b = along.x() * b.y() - along.y() * b.x();
  return std::min(side_a, side_b) <= radius && std::max(side_a, side_b) >= -radius;
}

}  // namespace

// The part of the ray above the grid and not yet above all that stands; empty: nothing is met.
std::optional<World::Stretch> World::stretch(const Ray& ray) const {
  const Eigen::Vector3d& o = ray.origin;
  const Eigen::Vector3d& d = ray.direction;
  if (!(o.allFinite() && d.allFinite())) return std::nullopt;
  Stretch way{0.0, ray.max_range};
  const Point2 size(columns_ * kBlock, rows_ * kBlock);
  for (int i = 0; i < 2; ++i) {
    const double low = origin_[i] - o[i];
    const double high = low + size[i];
    if (d[i] == 0.0) {
      if (low > 0.0 || high < 0.0) return std::nullopt;
      continue;
    }
    way.begin = std::max(way.begin, std::min(low / d[i], high / d[i]));
    way.end = std::min(way.end, std::max(low / d[i], high / d[i]));
  }
  if (d.z() > 0.0) way.end = std::min(way.end, (highest_ - o.z()) / d.z());
  if (!(way.begin < way.end)) return std::nullopt;
  return way;
}

RayHit World::trace(const Ray& ray, const BodyIndex& moving) const {
  const Eigen::Vector3d& o = ray.origin;
  const Eigen::Vector3d& d = ray.direction;
  RayHit hit;
  const std::optional<Stretch> way = stretch(ray);
  if (!way) return hit;
  double t = way->begin;
  const Point2 place = (o.head<2>() + t * d.head<2>() - origin_) / kBlock;
  Piece piece;
  piece.column = std::clamp(static_cast<int>(std::floor(place.x())), 0, columns_ - 1);
  piece.row = std::clamp(static_cast<int>(std::floor(place.y())), 0, rows_ - 1);
  Walk x(place.x(), piece.column, d.x() / kBlock, t);
  Walk y(place.y(), piece.row, d.y() / kBlock, t);
  const auto above_ground = [&](double at) {
    if (flat_) return o.z() + at * d.z();
    return o.z() + at * d.z() -
           height_in(piece.column, piece.row, o.x() + at * d.x(), o.y() + at * d.y());
  };
  double height = above_ground(t);
  if (height < 0.0) return hit;
  double depth = ray.depth;
  while (t < way->end && piece.column >= 0 && piece.column < columns_ && piece.row >= 0 &&
         piece.row < rows_) {
    piece.begin = t;
    piece.end = std::min({x.next, y.next, way->end});
    const double height_after = above_ground(piece.end);
    if (std::min(height, height_after) <= tallest_ && piece.end > t) {
      const double slope = (height_after - height) / (piece.end - t);
      piece.start = {o.x(), o.y(), height - t * slope};
      piece.step = {d.x(), d.y(), slope};
      if (hit_in(ray, moving, piece, depth, hit)) return hit;
    }
    t = piece.end;
    height = height_after;
    x.next < y.next ? x.advance(piece.column) : y.advance(piece.row);
  }
  return hit;
}

bool World::hit_in(const Ray& ray, const BodyIndex& moving, Piece& piece, double& depth,
                   RayHit& hit) const {
  const double height_after = piece.height(piece.end);
  if (height_after < 0.0) {
    const double t = -piece.start.z() / piece.step.z();
    const double cosine = flat_ ? -piece.step.z() : [&] {
      const Point2 gradient = ground(piece.start.head<2>() + t * piece.step.head<2>()).gradient;
      return -piece.step.z() / std::sqrt(1.0 + gradient.squaredNorm());
    }();
    piece.end = std::clamp(t, piece.begin, piece.end);
    hit = {piece.end, Surface::kGround, std::min(1.0, cosine), -1};
  }
  hit_bodies(ray, fixed_, piece, hit);
  hit_bodies(ray, moving, piece, hit);
  hit_porous(piece, depth, hit);
  return hit.surface != Surface::kNone;
}

void World::hit_bodies(const Ray& ray, const BodyIndex& index, Piece& piece, RayHit& hit) const {
  std::int32_t link = index.head.empty()
                          ? -1
                          : index.head[static_cast<std::size_t>(block(piece.column, piece.row))];
  if (link < 0) return;
  const double first = piece.height(piece.begin);
  const double second = piece.height(piece.end);
  const Point2 along = piece.step.head<2>().normalized();
  for (; link >= 0; link = index.links[static_cast<std::size_t>(link)].second) {
    const Body& body =
        index.bodies[static_cast<std::size_t>(index.links[static_cast<std::size_t>(link)].first)];
    double radius = body.radius;
    if (body.surface == Surface::kWire) {
      // The share of the ray's width that the wire fills.
      const double half_width = 0.5 * ray.width_rad * piece.begin;
      if (ray.chance * (radius + half_width) >= radius) continue;
      radius += half_width;
    }
    if (!near(body, std::min(first, second), std::max(first, second), piece.start.head<2>(), along,
              radius)) {
      continue;
    }
    const Contact contact = meet(piece.start, piece.step, body, radius);
    if (contact.t < piece.begin || contact.t > piece.end) continue;
    piece.end = contact.t;
    hit = {contact.t, body.surface, contact.cosine, body.agent};
  }
}

// Leaves stop a ray where the optical depth passed, G times leaf area density times the way,
// reaches the ray's. Densities are taken in the middles of even steps.
bool World::hit_porous(const Piece& piece, double& depth, RayHit& hit) const {
  const std::int32_t volume = volume_[static_cast<std::size_t>(block(piece.column, piece.row))];
  const double top = volume >= 0 ? layers_ * kVoxel : grass_top_;
  double t = piece.begin;
  double end = piece.end;
  const double slope = piece.step.z();
  if (slope < 0.0) {
    t = std::max(t, (top - piece.start.z()) / slope);
  } else if (slope > 0.0) {
    end = std::min(end, (top - piece.start.z()) / slope);
  } else if (piece.start.z() > top) {
    return false;
  }
  if (!(end - t > 1e-9) || depth == kInfinity) return false;

  const double steps = std::max(1.0, std::ceil((end - t) / kMarch - 1e-6));
  const double length = (end - t) / steps;
  const Eigen::Vector3d corner(origin_.x() + piece.column * kBlock,
                               origin_.y() + piece.row * kBlock, 0.0);
  Eigen::Vector3d place = (piece.start + (t + 0.5 * length) * piece.step - corner) / kVoxel;
  const Eigen::Vector3d step = piece.step * (length / kVoxel);
  const double grass_top = grass_top_ / kVoxel;
  for (int i = 0; i < static_cast<int>(steps); ++i, t += length, place += step) {
    const int column = std::clamp(static_cast<int>(place.x()), 0, kSide - 1);
    const int row = std::clamp(static_cast<int>(place.y()), 0, kSide - 1);
    double rate = 0.0;  // optical depth per metre
    if (volume >= 0) {
      const int layer = std::clamp(static_cast<int>(place.z()), 0, layers_ - 1);
      rate = kRate *
             voxels_[static_cast<std::size_t>(((volume + layer) * kSide + row) * kSide + column)];
    }
    const bool grass = place.z() < grass_top && kVoxel * place.z() < grass_at(piece, column, row);
    if (grass) rate += grass_rate_;
    if (rate * length < depth) {
      depth -= rate * length;
      continue;
    }
    hit = {t + depth / rate, grass ? Surface::kGrass : Surface::kCanopy, 1.0, -1};
    return true;
  }
  return false;
}

double World::grass_at(const Piece& piece, int column, int row) const {
  const int x = (piece.column * kSide + column) % kGrassSide;
  const int y = (piece.row * kSide + row) % kGrassSide;
  return static_cast<double>(grass_[static_cast<std::size_t>(y * kGrassSide + x)]);
}

}  // namespace headland::internal
