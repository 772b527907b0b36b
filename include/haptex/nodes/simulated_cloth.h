// A scene being simulated: the cloth, its state, its integrator, and how far it has come.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "haptex/cloth/cloth.h"
#include "haptex/cloth/integrator.h"
#include "haptex/cloth/scene.h"
#include "haptex/material/fabric.h"

namespace haptex::nodes {

/// Attached particles may not be sent farther from the world origin than this (m, per axis): far
/// beyond any workspace, but near enough to keep the numbers of a step finite.
constexpr double kLargestCoordinate = 100.0;

/// Steps a scene and changes it between two steps. Every change checks its whole request first and
/// throws without having changed anything. Units SI, places in the world frame.
class SimulatedCloth {
 public:
  /// @throws std::invalid_argument what cloth::Cloth throws for the scene
  SimulatedCloth(cloth::Scene scene, material::Fabric fabric);

  const cloth::Cloth& cloth() const { return cloth_; }
  const cloth::ClothState& state() const { return state_; }
  double timeStep() const { return time_step_; }  ///< s
  std::uint64_t steps() const { return steps_; }  ///< accepted since the start or reset()
  const cloth::StepReport& lastReport() const { return report_; }
  /// False again after reset().
  bool lastStepRejected() const { return last_step_rejected_; }

  /// Takes one step. @returns false if it was rejected and the state is as before
  bool step();

  /// Positions, velocities, attachments and time as at the start, without loads. The fabric stays.
  void reset();

  /// Takes effect in the next step; positions and velocities stay.
  void setFabric(material::Fabric fabric);

  /// Act until replaced. @throws std::invalid_argument what Cloth::setPointLoads() throws
  void setPointLoads(const std::vector<cloth::PointLoad>& loads);

  /// Attaches particles where they are now.
  /// @throws std::invalid_argument if there is none, one does not exist or is named twice
  void attach(const std::vector<std::uint32_t>& particles);

  /// Attaches particles to places, reached at the end of the next step.
  /// @throws std::invalid_argument also if there is not one finite place within
  ///   kLargestCoordinate for each
  void attach(const std::vector<std::uint32_t>& particles,
              const std::vector<Eigen::Vector3d>& places);

  /// Sends attached particles along straight minimum-jerk paths from where their attachments are
  /// now, which they reach exactly. An earlier path ends here.
  /// @param duration s of simulated time; 0: within the next step
  /// @throws std::invalid_argument also if one is not attached, the displacement or the duration
  ///   is not finite, the duration negative, or an end beyond kLargestCoordinate
  void move(const std::vector<std::uint32_t>& particles, const Eigen::Vector3d& displacement,
            double duration);

  /// @throws std::invalid_argument also if one is not attached
  void release(const std::vector<std::uint32_t>& particles);

  /// Exact Jacobian blocks of the rows of some particles, in the present state.
  /// @throws std::invalid_argument if there is none, one does not exist or is named twice
  std::vector<cloth::JacobianBlock> jacobian(const std::vector<std::uint32_t>& particles) const;

 private:
  std::vector<int> requireParticles(const std::vector<std::uint32_t>& particles) const;
  std::vector<int> requireAttached(const std::vector<std::uint32_t>& particles) const;
  void attachInitially();

  cloth::Cloth cloth_;
  cloth::ClothState state_;
  cloth::StepSettings step_settings_;
  cloth::Integrator integrator_;
  std::vector<int> initially_attached_;
  double time_step_;
  cloth::StepReport report_;
  bool last_step_rejected_ = false;
  std::uint64_t steps_ = 0;
};

}  // namespace haptex::nodes
