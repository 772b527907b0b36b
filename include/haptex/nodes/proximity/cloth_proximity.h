// Answers which elements of a cloth, known from its messages, are near a cursor or an obstacle.
#pragma once

#include <haptex/ClothMesh.h>
#include <haptex/ClothState.h>
#include <haptex/QueryProximity.h>
#include <ros/time.h>

#include <Eigen/Geometry>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "haptex/mesh/obstacle.h"
#include "haptex/nodes/proximity/fitted_cloth.h"
#include "haptex/proximity/kdop.h"
#include "haptex/proximity/rigid_obstacle.h"

namespace haptex::nodes {

/// How the answering goes. Counts are since the start; times are NaN before the first of its kind.
struct ProximityStatus {
  std::string trouble;        ///< why queries are refused now and what to do; empty: they are not
  double cloth_age = 0.0;     ///< s since the last good state arrived
  std::size_t triangles = 0;  ///< 0 without a mesh
  std::uint64_t meshes = 0;   ///< good ones
  std::uint64_t builds = 0;   ///< of the hierarchy
  std::uint64_t states = 0;   ///< good ones
  std::uint64_t dropped = 0;  ///< messages
  std::string dropped_why;    ///< what was wrong with the last of them
  std::uint64_t answered = 0;
  std::uint64_t refused = 0;
  std::string refused_why;      ///< what was wrong with the last of them
  std::uint64_t refits = 0;     ///< of the hierarchy
  double refit_seconds = 0.0;   ///< computing time of the last one
  double answer_seconds = 0.0;  ///< of the last answer, with the refit if it needed one
};

/// A request that was answered.
struct AnsweredQuery {
  haptex::QueryProximity::Request request;
  Eigen::Isometry3d world_from_frame = Eigen::Isometry3d::Identity();
};

/// What markers ask for.
struct SceneRequest {
  static constexpr int kNoLevel = -1, kAllLevels = -2;

  std::vector<int> triangles;           ///< indices; those that the mesh does not have are left out
  int level = kNoLevel;                 ///< of the volumes, the last one stands for those beyond it
  std::optional<AnsweredQuery> tested;  ///< by whose query volumes are tested
};

/// Volumes of the hierarchy that belong together.
struct VolumeGroup {
  std::string name;  ///< "volumes"; of all levels "volumes/0", ...; "tested_volumes"
  std::vector<proximity::Kdop> volumes;
  std::vector<int> colours;  ///< of each volume, distinctColour()
};

/// What markers need to know of one state of the cloth.
struct ProximityScene {
  ros::Time stamp;                             ///< of the state
  std::vector<proximity::Triangle> triangles;  ///< those asked for, m
  std::vector<VolumeGroup> volumes;            ///< likewise
};

/// Keeps the latest mesh and state, and the hierarchy over them. It is built for a new mesh and
/// adapted to a new state only when somebody asks. What is wrong with a message is counted and
/// kept for status(), and the last good one stays.
///
/// All functions may be called at the same time. Queries run beside each other, and a message never
/// waits for a query. Whether the cloth is stale is judged by when its states arrive on a clock
/// that nobody sets, not by their stamps.
class ClothProximity {
 public:
  using Clock = std::chrono::steady_clock;
  using Obstacles = std::map<std::string, proximity::RigidObstacle>;  // in the world frame
  /// Transform from the frame of a request to the world frame. Throws what is wrong with it.
  using FrameLookup = std::function<Eigen::Isometry3d()>;

  /// @param stale_after s, > 0: older states are not answered from
  /// @param moving those of the obstacles that move: they are asked about where they are at the
  ///   simulated time of the state, and those with mass where it has them; all of the scene, in
  ///   its order
  ClothProximity(double stale_after, Obstacles obstacles,
                 const std::vector<mesh::Obstacle>& moving = {});

  /// A mesh with the same triangles and rest coordinates, as comes with a change of the fabric,
  /// changes nothing.
  void setMesh(const haptex::ClothMesh& message);

  /// @param arrival when the message arrived
  void setState(const haptex::ClothStateConstPtr& message, Clock::time_point arrival);

  /// Answers or refuses, and never throws.
  /// @param world_from_frame called for a request that is sound so far and has a frame
  haptex::QueryProximity::Response answer(const haptex::QueryProximity::Request& request,
                                          const FrameLookup& world_from_frame,
                                          Clock::time_point now);

  /// The latest state, however old. Volumes are those that the query would test there.
  /// @returns nothing while there is no cloth
  std::optional<ProximityScene> scene(const SceneRequest& request);

  ProximityStatus status(Clock::time_point now) const;

 private:
  /// What an answer is computed on. A state always comes with the mesh that it belongs to.
  struct Cloth {
    std::shared_ptr<FittedCloth> fitted;  ///< null without a mesh
    ArrivedState state;                   ///< without a message if there is none yet
    Clock::time_point arrival;            ///< of the state
  };

  void drop(const std::string& topic, const std::string& why);
  std::string trouble(Clock::time_point now) const;
  Cloth requireLive(Clock::time_point now) const;
  FittedCloth::View look(const Cloth& cloth);
  proximity::RigidObstacle requireObstacle(const std::string& name) const;
  void moveObstacle(const std::string& name, const haptex::ClothState& state,
                    proximity::RigidObstacle& obstacle) const;
  std::vector<proximity::VolumeIndex> tested(const AnsweredQuery& query,
                                             const FittedCloth::View& view) const;
  std::vector<proximity::VolumeIndex> testedOrNone(const AnsweredQuery& query,
                                                   const FittedCloth::View& view) const;
  haptex::QueryProximity::Response compute(const haptex::QueryProximity::Request& request,
                                           const FrameLookup& world_from_frame,
                                           Clock::time_point now);

  const double stale_after_;  // s
  const Obstacles obstacles_;
  std::map<std::string, mesh::Obstacle> moving_;
  std::map<std::string, std::size_t> bodies_;  // where those with mass are in ClothState::bodies

  mutable std::mutex mutex_;  // guards all below; never held while something is computed
  Cloth latest_;
  ProximityStatus status_;
};

}  // namespace haptex::nodes
