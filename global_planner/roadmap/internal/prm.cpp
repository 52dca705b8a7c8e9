// SPDX-License-Identifier: Apache-2.0
#include "global_planner/roadmap/internal/prm.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <ompl/base/MotionValidator.h>
#include <ompl/base/OptimizationObjective.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/StateValidityChecker.h>
#include <ompl/base/ValidStateSampler.h>
#include <ompl/base/spaces/SE2StateSpace.h>
#include <ompl/geometric/planners/prm/PRM.h>
#include <ompl/util/Console.h>

#include "core/base/error.hpp"
#include "global_planner/roadmap/internal/pose_sampler.hpp"

// The roadmap is undirected, as OMPL's is: a node is a place with a direction, which a vehicle may
// pass in either heading, and an edge is a track that it may drive either way.
namespace headland::internal {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;
using State = ob::SE2StateSpace::StateType;

constexpr std::size_t kNeighbors = 16;  // joined to each new node, if so many can be
constexpr std::size_t kFirstLook = 32;  // nearest nodes looked at for them
constexpr std::size_t kLastLook = 128;
constexpr int kMostMisses = 20000;  // draws in a row that do not fit: there is no room

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

/// Asked by the sampler alone: does the vehicle fit in either heading?
class FreeStates : public ob::StateValidityChecker {
 public:
  FreeStates(const ob::SpaceInformationPtr& space, const TrackMaker& tracks, double margin)
      : ob::StateValidityChecker(space), tracks_(tracks), margin_(margin) {}
  bool isValid(const ob::State* state) const override {
    const Pose2 pose = pose_of(state);
    return tracks_.fits(pose, margin_) || tracks_.fits(reversed(pose), margin_);
  }

 private:
  const TrackMaker& tracks_;
  double margin_;
};

/// The sampler in OMPL's terms. Its numbers come from our own stream: OMPL's generators share a
/// global seed.
class FreeSampler : public ob::ValidStateSampler {
 public:
  FreeSampler(const ob::SpaceInformation* space, PoseSampler& poses)
      : ob::ValidStateSampler(space), poses_(poses) {}

  bool sample(ob::State* state) override {
    const auto pose = poses_.draw();
    if (!pose) return false;
    set(state, *pose);
    if (!si_->isValid(state)) return false;
    poses_.accept();
    return true;
  }
  bool sampleNear(ob::State*, const ob::State*, double) override { return false; }

 private:
  PoseSampler& poses_;
};

/// Finds a drivable track for a motion. It remembers those of the node at hand, which are asked for
/// again when the PRM makes edges of them.
class DrivableMotions : public ob::MotionValidator {
 public:
  DrivableMotions(const ob::SpaceInformationPtr& space, const TrackMaker& tracks, double margin)
      : ob::MotionValidator(space), tracks_(tracks), margin_(margin) {}

  bool checkMotion(const ob::State* from, const ob::State* to) const override {
    if (known(from, to)) return true;
    const auto edge = find(pose_of(from), pose_of(to));
    if (edge) known_.push_back({from, to, *edge});
    return edge.has_value();
  }
  bool checkMotion(const ob::State* from, const ob::State* to,
                   std::pair<ob::State*, double>&) const override {
    return checkMotion(from, to);
  }
  /// Of a motion that passed since the last forget().
  const RoadEdge* known(const ob::State* from, const ob::State* to) const {
    for (const Known& motion : known_) {
      if (motion.from == from && motion.to == to) return &motion.edge;
    }
    return nullptr;
  }
  void forget() { known_.clear(); }

 private:
  struct Known {
    const ob::State* from;
    const ob::State* to;
    RoadEdge edge;
  };

  std::optional<RoadEdge> find(const Pose2& from, const Pose2& to) const {
    const Joint j = joint(from, to);
    const auto track = tracks_.join(j.from_looks_back ? reversed(from) : from,
                                    j.to_looks_back ? reversed(to) : to);
    if (!track) return std::nullopt;
    RoadEdge edge;
    edge.track = *track;
    edge.open = tracks_.open_ways(*track, margin_);
    if (!edge.open.any()) return std::nullopt;
    const auto forwards = tracks_.cost(*track);
    const auto backwards = tracks_.cost(*track, true);
    if (!forwards || !backwards) return std::nullopt;
    edge.forwards = *forwards;
    edge.backwards = *backwards;
    return edge;
  }

  const TrackMaker& tracks_;
  double margin_;
  mutable std::vector<Known> known_;
};

/// Energy of an edge, the mean of its two ways [J]. The PRM asks once, when it makes the edge,
/// which is then kept in the PRM's own order.
class EdgeEnergy : public ob::OptimizationObjective {
 public:
  EdgeEnergy(const ob::SpaceInformationPtr& space, const DrivableMotions& motions,
             std::vector<RoadEdge>& edges)
      : ob::OptimizationObjective(space), motions_(motions), edges_(edges) {}
  ob::Cost stateCost(const ob::State*) const override { return ob::Cost(0.0); }
  ob::Cost motionCost(const ob::State* from, const ob::State* to) const override {
    const RoadEdge* edge = motions_.known(from, to);
    HEADLAND_CHECK(edge != nullptr, "the cost of a motion that was not checked");
    edges_.push_back(*edge);
    return of(*edge);
  }
  static ob::Cost of(const RoadEdge& edge) {
    return ob::Cost(0.5 * (edge.forwards.energy_j + edge.backwards.energy_j));
  }

 private:
  const DrivableMotions& motions_;
  std::vector<RoadEdge>& edges_;
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
      boost::add_edge(from, to, Graph::edge_property_type(EdgeEnergy::of(edge)), g_);
      uniteComponents(from, to);
    }
  }

  const ob::State* state(Vertex v) const { return boost::get(vertex_state_t(), g_, v); }
};

/// Connection strategy: the nearest nodes that a drivable track joins to the new one.
class DrivableNeighbors {
 public:
  DrivableNeighbors(Prm& prm, DrivableMotions& motions) : prm_(prm), motions_(motions) {}

  const std::vector<Prm::Vertex>& operator()(Prm::Vertex v) {
    found_.clear();
    motions_.forget();
    std::size_t looked = 0;
    for (std::size_t look = kFirstLook; look <= kLastLook; look *= 2) {
      prm_.getNearestNeighbors()->nearestK(v, look, near_);
      for (; looked < near_.size() && found_.size() < kNeighbors; ++looked) {
        const Prm::Vertex u = near_[looked];
        if (motions_.checkMotion(prm_.state(u), prm_.state(v))) found_.push_back(u);
      }
      if (found_.size() >= kNeighbors || near_.size() < look) break;
    }
    return found_;
  }

 private:
  Prm& prm_;
  DrivableMotions& motions_;
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

ob::RealVectorBounds bounds_of(const PoseSampler& poses) {
  ob::RealVectorBounds bounds(2);
  for (unsigned i = 0; i < 2; ++i) {
    bounds.setLow(i, poses.low()[i]);
    bounds.setHigh(i, poses.high()[i]);
  }
  return bounds;
}

/// Takes nodes, and the ends of new edges, from the PRM.
void take_over(const Prm& prm, RoadGraph& graph) {
  for (auto v = graph.nodes.size(); v < prm.milestoneCount(); ++v) {
    graph.nodes.push_back(pose_of(prm.state(v)));
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
  PoseSampler poses(tracks.drivable(), tracks.radius(), seed, graph.draws);
  const auto space = std::make_shared<DirectionSpace>(tracks.radius());
  space->setBounds(bounds_of(poses));
  const auto information = std::make_shared<ob::SpaceInformation>(space);
  information->setStateValidityChecker(std::make_shared<FreeStates>(information, tracks, margin));
  const auto motions = std::make_shared<DrivableMotions>(information, tracks, margin);
  information->setMotionValidator(motions);
  information->setValidStateSamplerAllocator(
      [&](const ob::SpaceInformation* si) { return std::make_shared<FreeSampler>(si, poses); });
  const auto problem = std::make_shared<ob::ProblemDefinition>(information);
  problem->setOptimizationObjective(
      std::make_shared<EdgeEnergy>(information, *motions, graph.edges));

  Prm prm(information);
  prm.setProblemDefinition(problem);
  prm.setConnectionStrategy(DrivableNeighbors(prm, *motions));
  prm.setup();
  prm.restore(graph);
  prm.growRoadmap(ob::PlannerTerminationCondition([&] {
    return prm.milestoneCount() >= static_cast<unsigned long>(samples) ||
           poses.misses() >= kMostMisses;
  }));
  graph.draws = poses.draws();
  take_over(prm, graph);
}

}  // namespace headland::internal
