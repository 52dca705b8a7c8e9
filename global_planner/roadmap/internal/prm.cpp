// SPDX-License-Identifier: Apache-2.0
#include "global_planner/roadmap/internal/prm.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <ompl/base/MotionValidator.h>
#include <ompl/base/OptimizationObjective.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/StateValidityChecker.h>
#include <ompl/base/ValidStateSampler.h>
#include <ompl/base/spaces/SE2StateSpace.h>
#include <ompl/geometric/planners/prm/PRM.h>
#include <ompl/util/Console.h>

#include "core/base/random.hpp"

// The roadmap is undirected, as OMPL's is: a node is a place with a direction, which a vehicle may
// pass in either heading, and an edge is a track that it may drive either way.
namespace headland::internal {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;
using State = ob::SE2StateSpace::StateType;

constexpr std::size_t kNeighbors = 16;  // tried for each new node: those that a curve can join
constexpr std::size_t kFirstLook = 32;  // nearest nodes looked at for them
constexpr std::size_t kLastLook = 256;
constexpr std::int64_t kMostMisses = 20000;  // draws in a row that do not fit: there is no room

Pose2 pose_of(const ob::State* state) {
  const auto* se2 = state->as<State>();
  return {se2->getX(), se2->getY(), se2->getYaw()};
}

void set(ob::State* state, const Pose2& pose) {
  auto* se2 = state->as<State>();
  se2->setXY(pose.x, pose.y);
  se2->setYaw(pose.yaw);
}

/// Places with a direction: the distance in the plane, and an arc of the turning radius for the
/// angle between the directions.
class DirectionSpace : public ob::SE2StateSpace {
 public:
  explicit DirectionSpace(double radius) : radius_(radius) {}
  double distance(const ob::State* a, const ob::State* b) const override {
    const Pose2 p = pose_of(a);
    const Pose2 q = pose_of(b);
    return (p.position() - q.position()).norm() +
           radius_ * std::abs(std::remainder(p.yaw - q.yaw, kPi));
  }

 private:
  double radius_;
};

/// The headings in which a track leaves a node and arrives at another: both within a right angle of
/// the chord, where curves are short and bend little.
struct Joint {
  bool from_looks_back = false;
  bool to_looks_back = false;
};
Joint joint(const Pose2& from, const Pose2& to) {
  const Point2 chord = to.position() - from.position();
  return {chord.dot(from.heading()) < 0.0, chord.dot(to.heading()) < 0.0};
}

std::optional<Track> join_nodes(const TrackMaker& tracks, const Pose2& from, const Pose2& to) {
  const Joint j = joint(from, to);
  return tracks.join(j.from_looks_back ? reversed(from) : from,
                     j.to_looks_back ? reversed(to) : to);
}

/// Asked by the sampler alone: does the vehicle fit in either heading?
class FreeStates : public ob::StateValidityChecker {
 public:
  FreeStates(const ob::SpaceInformationPtr& space, const TrackMaker& tracks, double margin)
      : ob::StateValidityChecker(space), tracks_(tracks), margin_(margin) {}
  bool isValid(const ob::State* state) const override {
    const Pose2 pose = pose_of(state);
    return tracks_.drivable().contains(pose.position()) &&
           (tracks_.fits(pose, margin_) || tracks_.fits(reversed(pose), margin_));
  }

 private:
  const TrackMaker& tracks_;
  double margin_;
};

/// Draws places in the box around the area and directions from our own stream: OMPL's generators
/// share a global seed.
class Sampler : public ob::ValidStateSampler {
 public:
  Sampler(const ob::SpaceInformation* space, RandomStream& random, std::int64_t& draws)
      : ob::ValidStateSampler(space), random_(random), draws_(draws) {}

  bool sample(ob::State* state) override {
    const auto& bounds = si_->getStateSpace()->as<ob::SE2StateSpace>()->getBounds();
    const double x = random_.uniform(bounds.low[0], bounds.high[0]);
    const double y = random_.uniform(bounds.low[1], bounds.high[1]);
    set(state, {x, y, random_.uniform(0.0, kPi)});
    ++draws_;
    return si_->isValid(state);
  }
  bool sampleNear(ob::State*, const ob::State*, double) override { return false; }

 private:
  RandomStream& random_;
  std::int64_t& draws_;
};

/// Finds a drivable track for each motion that the PRM tries, and keeps it: the PRM makes an edge
/// of each motion that passes, in the same order.
class DrivableMotions : public ob::MotionValidator {
 public:
  DrivableMotions(const ob::SpaceInformationPtr& space, const TrackMaker& tracks, double margin,
                  std::vector<RoadEdge>& edges)
      : ob::MotionValidator(space), tracks_(tracks), margin_(margin), edges_(edges) {}

  bool checkMotion(const ob::State* from, const ob::State* to) const override {
    const auto track = join_nodes(tracks_, pose_of(from), pose_of(to));
    if (!track) return false;
    RoadEdge edge;
    edge.track = *track;
    edge.open = tracks_.open_ways(*track, margin_);
    if (!edge.open.any()) return false;
    const auto forwards = tracks_.cost(*track);
    const auto backwards = tracks_.cost(*track, true);
    if (!forwards || !backwards) return false;
    edge.forwards = *forwards;
    edge.backwards = *backwards;
    edges_.push_back(edge);
    return true;
  }
  bool checkMotion(const ob::State* from, const ob::State* to,
                   std::pair<ob::State*, double>&) const override {
    return checkMotion(from, to);
  }

 private:
  const TrackMaker& tracks_;
  double margin_;
  std::vector<RoadEdge>& edges_;
};

/// The energy of the edge just made, the mean of its two ways [J].
class EdgeEnergy : public ob::OptimizationObjective {
 public:
  EdgeEnergy(const ob::SpaceInformationPtr& space, const std::vector<RoadEdge>& edges)
      : ob::OptimizationObjective(space), edges_(edges) {}
  ob::Cost stateCost(const ob::State*) const override { return ob::Cost(0.0); }
  ob::Cost motionCost(const ob::State*, const ob::State*) const override {
    const RoadEdge& edge = edges_.back();
    return ob::Cost(0.5 * (edge.forwards.energy_j + edge.backwards.energy_j));
  }

 private:
  const std::vector<RoadEdge>& edges_;
};

/// OMPL's PRM, that can also go on with an earlier graph.
class Prm : public og::PRM {
 public:
  using og::PRM::PRM;

  void restore(const RoadGraph& graph) {
    for (const Pose2& pose : graph.nodes) {
      ob::State* state = si_->allocState();
      set(state, pose);
      const Vertex v = boost::add_vertex(g_);
      stateProperty_[v] = state;
      totalConnectionAttemptsProperty_[v] = 1;
      successfulConnectionAttemptsProperty_[v] = 0;
      disjointSets_.make_set(v);
      nn_->add(v);
    }
    for (const RoadEdge& edge : graph.edges) {
      const auto from = static_cast<Vertex>(edge.from / 2);
      const auto to = static_cast<Vertex>(edge.to / 2);
      const ob::Cost weight(0.5 * (edge.forwards.energy_j + edge.backwards.energy_j));
      boost::add_edge(from, to, Graph::edge_property_type(weight), g_);
      uniteComponents(from, to);
    }
  }

  Pose2 pose(Vertex v) const { return pose_of(boost::get(vertex_state_t(), g_, v)); }
};

/// Connection strategy: the nearest nodes that a curve can join, whatever lies in between.
class JoinableNeighbors {
 public:
  JoinableNeighbors(Prm& prm, const TrackMaker& tracks) : prm_(prm), tracks_(tracks) {}

  const std::vector<Prm::Vertex>& operator()(Prm::Vertex v) {
    found_.clear();
    std::size_t looked = 0;
    for (std::size_t look = kFirstLook; look <= kLastLook; look *= 2) {
      prm_.getNearestNeighbors()->nearestK(v, look, near_);
      for (; looked < near_.size() && found_.size() < kNeighbors; ++looked) {
        const Prm::Vertex u = near_[looked];
        if (u != v && join_nodes(tracks_, prm_.pose(u), prm_.pose(v))) found_.push_back(u);
      }
      if (found_.size() >= kNeighbors || near_.size() < look) break;
    }
    return found_;
  }

 private:
  Prm& prm_;
  const TrackMaker& tracks_;
  std::vector<Prm::Vertex> near_;
  std::vector<Prm::Vertex> found_;
};

/// OMPL reports to standard output, which is not a library's to use.
class QuietOmpl {
 public:
  QuietOmpl() : level_(ompl::msg::getLogLevel()) { ompl::msg::setLogLevel(ompl::msg::LOG_NONE); }
  ~QuietOmpl() { ompl::msg::setLogLevel(level_); }
  QuietOmpl(const QuietOmpl&) = delete;
  QuietOmpl& operator=(const QuietOmpl&) = delete;

 private:
  ompl::msg::LogLevel level_;
};

ob::RealVectorBounds box_around(const Region& region) {
  Point2 low = region.polygons().front().outer.front();
  Point2 high = low;
  for (const Polygon& polygon : region.polygons()) {
    for (const Point2& p : polygon.outer) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  }
  ob::RealVectorBounds bounds(2);
  for (unsigned i = 0; i < 2; ++i) {
    bounds.setLow(i, low[i]);
    bounds.setHigh(i, high[i]);
  }
  return bounds;
}

/// Takes nodes, and the ends of new edges, from the PRM.
void take_over(const Prm& prm, RoadGraph& graph) {
  for (auto v = graph.nodes.size(); v < prm.milestoneCount(); ++v) {
    graph.nodes.push_back(prm.pose(v));
  }
  std::size_t i = 0;
  const auto [first, last] = boost::edges(prm.getRoadmap());
  for (auto e = first; e != last; ++e, ++i) {
    const auto from = boost::source(*e, prm.getRoadmap());
    const auto to = boost::target(*e, prm.getRoadmap());
    const Joint j = joint(graph.nodes[from], graph.nodes[to]);
    graph.edges[i].from = static_cast<Heading>(2 * from) + (j.from_looks_back ? 1 : 0);
    graph.edges[i].to = static_cast<Heading>(2 * to) + (j.to_looks_back ? 1 : 0);
  }
}

}  // namespace

void RoadGraph::cut(int count) {
  if (static_cast<std::size_t>(count) < nodes.size()) nodes.resize(static_cast<std::size_t>(count));
  const auto gone = [&](const RoadEdge& e) { return std::max(e.from, e.to) >= headings(); };
  edges.erase(std::remove_if(edges.begin(), edges.end(), gone), edges.end());
}

void grow(RoadGraph& graph, const TrackMaker& tracks, int samples, std::uint64_t seed,
          double margin) {
  const bool full = static_cast<int>(graph.nodes.size()) < graph.samples;
  graph.samples = std::max(graph.samples, samples);
  if (full || tracks.drivable().polygons().empty()) return;
  const QuietOmpl quiet;
  RandomStream random(seed, "roadmap");
  for (std::int64_t i = 0; i < 3 * graph.draws; ++i) random.uniform();

  const auto space = std::make_shared<DirectionSpace>(tracks.radius());
  space->setBounds(box_around(tracks.drivable()));
  const auto information = std::make_shared<ob::SpaceInformation>(space);
  information->setStateValidityChecker(std::make_shared<FreeStates>(information, tracks, margin));
  information->setMotionValidator(
      std::make_shared<DrivableMotions>(information, tracks, margin, graph.edges));
  information->setValidStateSamplerAllocator([&](const ob::SpaceInformation* si) {
    return std::make_shared<Sampler>(si, random, graph.draws);
  });
  const auto problem = std::make_shared<ob::ProblemDefinition>(information);
  problem->setOptimizationObjective(std::make_shared<EdgeEnergy>(information, graph.edges));

  Prm prm(information);
  prm.setProblemDefinition(problem);
  prm.setConnectionStrategy(JoinableNeighbors(prm, tracks));
  prm.setup();
  prm.restore(graph);
  unsigned long nodes = 0;
  std::int64_t last_found = graph.draws;
  prm.growRoadmap(ob::PlannerTerminationCondition([&] {
    if (prm.milestoneCount() != nodes) last_found = graph.draws;
    nodes = prm.milestoneCount();
    return nodes >= static_cast<unsigned long>(samples) || graph.draws - last_found >= kMostMisses;
  }));
  take_over(prm, graph);
}

}  // namespace headland::internal
