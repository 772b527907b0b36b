// Frames that carry particles of a simulated cloth, and what the cloth does to them.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <string>
#include <vector>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/scene/attachment_values.h"

namespace haptex::simulation {

/// What a cloth does to a frame that carries particles of it.
struct FrameWrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   ///< N, world axes
  Eigen::Vector3d torque = Eigen::Vector3d::Zero();  ///< N.m, about the frame's origin, world axes
};

/// Attached particles may not be sent farther from the world origin than this (m, per axis): far
/// beyond any workspace, but near enough to keep the numbers of a step finite.
constexpr double kMaxCoordinate = 100.0;

/// @throws std::invalid_argument naming the frame and what is allowed, unless its pose is finite,
///   with its origin within kMaxCoordinate
void requireFramePose(const std::string& frame, const Eigen::Isometry3d& pose);

/// Frames with their poses in the world and the particles that go with them. A step takes the
/// particles in straight lines to where their frames are to be at its end, each at most kFastest:
/// one that appears elsewhere draws its particles after it. Moving allocates nothing.
class CarryingFrames {
 public:
  static constexpr double kFastest = 5.0;  ///< m/s
  /// m: a particle that is nearer to its place stays.
  static constexpr double kStill = 1e-9;

  CarryingFrames(std::vector<scene::CarryingFrame> frames, std::size_t particle_count);

  std::size_t size() const { return frames_.size(); }
  const std::string& name(std::size_t frame) const { return frames_[frame].name; }
  /// Those that it carries now.
  const std::vector<int>& particles(std::size_t frame) const { return frames_[frame].particles; }
  const Eigen::Isometry3d& pose(std::size_t frame) const { return poses_[frame]; }

  /// Where a frame is to be at the end of the next step.
  /// @param pose finite
  void move(std::size_t frame, const Eigen::Isometry3d& pose) { poses_[frame] = pose; }
  /// Carries particles from where they are in the frame's pose.
  /// @param name of a frame that is there, or a new one
  void carry(const std::string& name, const Eigen::Isometry3d& pose,
             const std::vector<int>& particles, const cloth::ClothState& state);
  /// Carries a particle no longer, whatever carried it.
  void drop(int particle);
  /// As at the start.
  void reset();

  /// Whether the next step moves a particle.
  bool moves(const cloth::Cloth& cloth, const cloth::ClothState& state) const;
  /// Gives particles their paths in a step that begins now.
  /// @param excluded per particle; those that are stay where they are. Empty: none is.
  void beginStep(cloth::Cloth& cloth, const cloth::ClothState& state, double duration,
                 const std::vector<char>& excluded);

  /// By the particles that it carries, with the inertia of their masses in the last step.
  /// @param forces of all particles in the state at the end of the step (N):
  ///   cloth::Cloth::computeForces()
  FrameWrench wrench(std::size_t frame, const cloth::Cloth& cloth, const cloth::ClothState& state,
                     const std::vector<Eigen::Vector3d>& forces) const;

 private:
  Eigen::Vector3d placeOf(std::size_t frame, std::size_t i) const {
    return poses_[frame] * frames_[frame].places[i];
  }

  std::vector<scene::CarryingFrame> start_;
  std::vector<scene::CarryingFrame> frames_;
  std::vector<Eigen::Isometry3d> poses_;
  // Per particle, of the step that began last.
  std::vector<Eigen::Vector3d> velocities_;  // m/s, at its begin
  double duration_ = 0.0;                    // s; 0: there was none
};

}  // namespace haptex::simulation
