// What the steps of a scene take, and how that compares with another scene.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/contact/obstacles/obstacle_collision.h"
#include "haptex/material/fabric.h"
#include "haptex/scene/scene.h"

namespace haptex::simulation {

/// Bytes that the process has allocated; 0 with the address sanitizer, which brings its own malloc.
std::size_t allocatedBytes();

/// Computing time of this thread (s), without what other processes take.
double threadSeconds();

/// A scene that never rests, stepped as cloth_simulation steps it: what is attached goes to and fro
/// by 20 mm along x, and after kPeriod all begins again.
class SteppedScene {
 public:
  static constexpr double kPeriod = 0.8;  ///< s, of simulated time

  /// @throws std::invalid_argument what cloth::Cloth and contact::ObstacleCollision throw
  SteppedScene(const scene::Scene& scene, std::vector<material::Fabric> fabrics);

  /// Of every step from now on.
  void setPointLoads(const std::vector<cloth::PointLoad>& loads) { cloth_.setPointLoads(loads); }
  /// @throws std::runtime_error if the step was rejected
  void step();
  /// The motion begins again.
  void restart();
  /// Computing time (s) of so many steps from the beginning of the motion.
  double secondsFor(int steps);

  const cloth::Cloth& cloth() const { return cloth_; }
  const cloth::ClothState& state() const { return state_; }
  double timeStep() const { return time_step_; }  ///< s

 private:
  void shake();

  cloth::Cloth cloth_;
  cloth::ClothState start_;
  cloth::ClothState state_;
  std::optional<contact::ObstacleCollision> collision_;
  cloth::Integrator integrator_;
  std::vector<int> attached_;
  double time_step_;
  int strokes_ = 0;  // of the shaking, begun
};

struct StepCost {
  double seconds = 0.0;  ///< computing time of a step, in the shortest turn: others were disturbed
  double ratio = 0.0;    ///< to a step of the base in its shortest turn
  double noise = 0.0;    ///< by how much at least three of four turns of the base are longer
};

/// Measures two scenes in turns, base, scene, base, so that what disturbs one disturbs the other.
/// @param rounds, steps > 0; steps per turn, each from the beginning of the motion
StepCost compareSteps(SteppedScene& scene, SteppedScene& base, int rounds, int steps);

}  // namespace haptex::simulation
