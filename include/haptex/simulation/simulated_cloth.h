// A scene being simulated: the cloth, its state, its integrator, and how far it has come.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/dynamics/cloth_part.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/cloth/dynamics/rest_detector.h"
#include "haptex/cloth/dynamics/step_length_control.h"
#include "haptex/contact/obstacles/obstacle_collision.h"
#include "haptex/material/fabric.h"
#include "haptex/scene/scene.h"
#include "haptex/simulation/carrying_frames.h"
#include "haptex/simulation/quality_controller.h"

namespace haptex::simulation {

/// How a step of the scene is taken: in equal substeps, each by these settings. While point loads
/// act, an implicit method of second order gives way to backward Euler, unless the plan is
/// adaptive: what makes the loads, a patch at 1 kHz, answers a step late, and a method that damps
/// nothing gains energy by that (docs/quality.md).
struct StepPlan {
  cloth::StepSettings step;
  int substeps = 1;  ///< > 0
  int cycles = 1;    ///< > 0, how many steps of the scene stepInRealTime() takes as one; 1 with
                     ///< several substeps
  /// Substeps as long as their error allows instead; only with one substep and one cycle.
  std::optional<cloth::AdaptiveSteps> adaptive = {};
};

/// Of the last step of a plan that is adaptive.
struct AdaptiveReport {
  int substeps = 0;       ///< taken
  int repeated = 0;       ///< tried before, and not taken because they were too long
  double shortest = 0.0;  ///< s, of those taken
  double error = 0.0;     ///< m, the largest of those taken (cloth::StepLengthControl)
  bool missed = false;    ///< the error that is allowed, by a substep of the shortest length
};

/// A fastener that opened by itself.
struct OpenedFastener {
  std::size_t fastener;  ///< of Cloth::fasteners()
  double force;          ///< N, at which it did
};

/// Steps a scene and changes it between two steps. Every change checks its whole request first and
/// throws without having changed anything. Units SI, places in the world frame.
///
/// Cloth that has come to rest (cloth::RestDetector) sleeps: its steps only let the time pass.
/// Every change wakes it, and it goes on from the state in which it fell asleep. It does not fall
/// asleep as long as something outside moves: an attachment on its way, wind that changes, or an
/// obstacle that moves or has mass.
class SimulatedCloth {
 public:
  /// @throws std::invalid_argument what cloth::Cloth throws for the scene, and
  ///   contact::ObstacleCollision if the cloth collides with its obstacles, or if an obstacle has
  ///   mass or the scene a penalty that a plan's integrator does not know
  SimulatedCloth(scene::Scene scene, material::Fabric fabric);
  /// @param fabrics of the scene (scene::loadSceneFabrics())
  SimulatedCloth(scene::Scene scene, std::vector<material::Fabric> fabrics);

  /// Can take its steps by any of these plans, at first by number 0, instead of by the scene's
  /// settings.
  /// @throws std::invalid_argument also if there is no plan or one has no substep, and what
  ///   cloth::Integrator throws for their settings
  SimulatedCloth(scene::Scene scene, material::Fabric fabric, std::vector<StepPlan> plans);
  SimulatedCloth(scene::Scene scene, std::vector<material::Fabric> fabrics,
                 std::vector<StepPlan> plans);

  const cloth::Cloth& cloth() const { return cloth_; }
  const cloth::ClothState& state() const { return state_; }
  /// The obstacles with mass, in the scene's order, where they are now.
  const std::vector<contact::FreeBody>& bodies() const;
  double timeStep() const { return time_step_; }  ///< s, of the scene: of all substeps together
  std::uint64_t steps() const { return steps_; }  ///< accepted since the start or reset()
  /// Of the last step: sums of counts and times over its substeps, the rest of the last of them.
  const cloth::StepReport& lastReport() const { return report_; }
  /// All zero without a plan that is adaptive.
  const AdaptiveReport& lastAdaptiveReport() const { return adaptive_report_; }
  /// False again after reset().
  bool lastStepRejected() const { return last_step_rejected_; }

  /// Takes one step, with all its substeps. @returns false if one was rejected and the state is as
  /// before the first
  bool step();
  /// The same over another time (s) than that of the scene.
  /// @throws std::invalid_argument what requireDuration() says
  bool step(double duration);
  /// @throws std::invalid_argument unless it is from scene::kShortestTimeStep to
  ///   scene::kLongestTimeStep
  static void requireDuration(double duration);
  /// As step(), but as many steps of the scene at once as the plan says.
  /// @param waited s, how long the step has waited for its turn; counts as computing time for the
  ///   controller
  bool stepInRealTime(double waited);
  double lastStepDuration() const { return last_duration_; }  ///< s of simulated time
  bool asleep() const { return asleep_; }
  /// Accepted since the construction, without those that were slept through.
  std::uint64_t computedSteps() const { return computed_steps_; }

  /// The next steps are taken by this plan. Positions, velocities and all else stay; a method that
  /// needs more than one state of the past starts anew. Allocates nothing.
  /// @throws std::invalid_argument if there is no such plan
  void use(std::size_t plan);
  std::size_t plan() const { return plan_; }  ///< of the next step

  /// From now on every step is timed and told to the controller, which chooses the plan of the
  /// next.
  /// @throws std::invalid_argument unless it chooses among as many qualities as there are plans
  void setController(QualityController controller);
  /// Whether no plan is left that is cheaper than the next step's and that the controller may take.
  bool runsCheapest() const { return !controller_ || controller_->runsCheapest(); }
  /// For a loop that else had to give up time: the next steps are by the cheapest of those.
  void relieve();
  /// Null without one.
  const QualityController* controller() const { return controller_ ? &*controller_ : nullptr; }

  /// Positions, velocities, attachments, bodies and time as at the start, without loads or external
  /// forces, with all particles. The fabric stays.
  void reset();

  /// Changes the fabric of the cloth, and those of its regions not. Takes effect in the next step;
  /// positions and velocities stay.
  /// @throws std::invalid_argument if the cloth cannot be made of it; nothing has changed then
  void setFabric(material::Fabric fabric);
  /// Changes all fabrics, gravity and air, likewise.
  /// @throws std::invalid_argument what cloth::Cloth::setMaterial() and
  ///   contact::ObstacleCollision::requireFriction() throw; nothing has changed then
  void setMaterial(std::vector<material::Fabric> fabrics, const Eigen::Vector3d& gravity,
                   const std::optional<cloth::Air>& air);

  /// Act until replaced. @throws std::invalid_argument what Cloth::setPointLoads() throws
  void setPointLoads(const std::vector<cloth::PointLoad>& loads);

  /// User-defined external force (N) on a particle, until set again; zero at first. It acts as
  /// gravity does. Allocates nothing.
  /// @throws std::invalid_argument what Cloth::setExternalForce() throws
  void setExternalForce(std::uint32_t particle, const Eigen::Vector3d& force);

  /// Puts particles elsewhere and gives them other velocities; time, attachments and loads stay.
  /// Methods that need the past start anew, and with positions so does what is remembered of
  /// friction inside of the fabric (cloth::Cloth::forget()). A state that intersects itself is
  /// pulled apart (cloth::Untangling). A particle that is set into a solid obstacle is outside
  /// after the next step; cloth that collides with itself stays caught in what it was set into.
  /// @param particles  empty: all, in their order
  /// @param positions  m, one per particle; empty: they stay
  /// @param velocities m/s, likewise
  /// @throws std::invalid_argument if a particle does not exist or is named twice, both other lists
  ///   are empty or one has another length, a component is not finite or beyond
  ///   proximity::kMaxLength, or an attached particle would get another position than where it is
  ///   attached, or another velocity than it has (more than scene::kHeldTolerance away)
  void setState(const std::vector<std::uint32_t>& particles,
                const std::vector<Eigen::Vector3d>& positions,
                const std::vector<Eigen::Vector3d>& velocities);

  /// Attaches particles where they are now.
  /// @throws std::invalid_argument if there is none, one does not exist or is named twice
  void attach(const std::vector<std::uint32_t>& particles);

  /// Attaches particles to places, reached at the end of the next step.
  /// @throws std::invalid_argument also if there is not one finite place within
  ///   kMaxCoordinate for each
  void attach(const std::vector<std::uint32_t>& particles,
              const std::vector<Eigen::Vector3d>& places);

  /// Sends attached particles along straight minimum-jerk paths from where their attachments are
  /// now, which they reach exactly. An earlier path ends here.
  /// @param duration s of simulated time; 0: within the next step
  /// @throws std::invalid_argument also if one is not attached, the displacement or the duration
  ///   is not finite, the duration negative, or an end beyond kMaxCoordinate
  void move(const std::vector<std::uint32_t>& particles, const Eigen::Vector3d& displacement,
            double duration);

  /// @throws std::invalid_argument also if one is not attached
  void release(const std::vector<std::uint32_t>& particles);

  /// Attaches particles to a frame where they are now: they go with it.
  /// @param frame one that carries others already, or a new one
  /// @param pose  of the frame in the world
  /// @throws std::invalid_argument if there is none, one does not exist or is named twice, the name
  ///   is no scene::isFrameName(), or what requireFramePose() throws
  void attach(const std::vector<std::uint32_t>& particles, const std::string& frame,
              const Eigen::Isometry3d& pose);

  /// The frame is in this pose at the end of the next step, and stays there. Allocates nothing.
  /// @param frame < frames().size()
  /// @throws std::invalid_argument what requireFramePose() throws
  void moveFrame(std::size_t frame, const Eigen::Isometry3d& pose);
  const CarryingFrames& frames() const { return frames_; }

  /// Fastens what is open, from the next step on. Those that are fastened stay so.
  /// @param names of the scene's fasteners; empty: all
  /// @throws std::invalid_argument if there is no fastener of a name, or the places of one are
  ///   farther apart than Fasteners::reach()
  void fasten(const std::vector<std::string>& names);
  /// Opens what is fastened, likewise.
  /// @throws std::invalid_argument if there is no fastener of a name
  void unfasten(const std::vector<std::string>& names);
  /// @param fastener of Cloth::fasteners()
  bool isFastened(std::size_t fastener) const { return fastened_[fastener] != 0; }
  /// N, that it carries; 0 if it is open.
  double fastenerForce(std::size_t fastener) const;
  /// What opened by itself in the last step, in the order of Cloth::fasteners(). A step that was
  /// rejected opens nothing.
  const std::vector<OpenedFastener>& openedFasteners() const { return opened_; }

  /// Takes particles out of the computation: they stand still where they are, attached, and what
  /// only they would need is not computed. Obstacles and loads go through them. Those that are
  /// excluded stay so.
  /// @throws std::invalid_argument also if none would be left, or what cloth::ClothPart throws
  void exclude(const std::vector<std::uint32_t>& particles);

  /// Takes them in again, from rest where they are, with the friction inside of the fabric that
  /// they had; those that were attached before are attached there. Those that are included stay so.
  /// @param particles empty: all
  /// @throws std::invalid_argument if one does not exist or is named twice
  void include(const std::vector<std::uint32_t>& particles);

  /// Per particle, nonzero where it is excluded; empty: none is.
  const std::vector<char>& excluded() const { return excluded_; }

  /// Exact Jacobian blocks of the rows of some particles, in the present state.
  /// @throws std::invalid_argument if there is none, one does not exist or is named twice
  std::vector<cloth::JacobianBlock> jacobian(const std::vector<std::uint32_t>& particles) const;

 private:
  std::vector<int> requireSome(const std::vector<std::uint32_t>& particles) const;
  std::vector<int> requireAttached(const std::vector<std::uint32_t>& particles) const;
  void requireIncluded(const std::vector<int>& particles) const;
  void compute(std::vector<char> excluded);
  cloth::Cloth& computed() { return part_ ? part_->cloth() : cloth_; }
  void requireHeld(int particle, const Eigen::Vector3d* position,
                   const Eigen::Vector3d* velocity) const;
  /// What a step changes beside what the integrators remember.
  struct Snapshot {
    cloth::ClothState state;
    std::vector<contact::FreeBody> bodies;
  };

  void keep(Snapshot& snapshot) const;
  void bringBack(const Snapshot& snapshot);
  cloth::ClothState startState() const;
  void attachInitially();
  void makeIntegrators();
  void setPenalty(double stiffness);
  bool run(double duration, int cycles, double waited);
  void runSubsteps(double duration);
  void runAdaptiveSubsteps(double duration);
  cloth::StepReport runSubstep(double duration);
  void wake();
  void sleepIfResting();
  std::vector<std::size_t> requireFasteners(const std::vector<std::string>& names) const;
  void setFastened(std::size_t fastener, bool fastened);
  void requireFastened();
  void readFastened();
  void noteOpenedFasteners();

  cloth::Cloth cloth_;
  std::vector<char> excluded_;            // whether it was attached before, too; empty: none is
  std::optional<cloth::ClothPart> part_;  // that is computed instead of cloth_, if any is excluded
  bool loaded_ = false;                   // with point loads
  bool pushed_ = false;                   // external forces have been set
  std::vector<Eigen::Vector3d> start_velocities_;  // m/s; empty: at rest
  double start_time_;                              // s
  cloth::ClothState state_;
  Snapshot before_;          // the step, if a plan has several substeps
  Snapshot before_substep_;  // of a plan that is adaptive
  std::vector<StepPlan> plans_;
  std::vector<cloth::Integrator> integrators_;                    // one per plan
  std::vector<std::optional<cloth::Integrator>> loaded_ones_;     // likewise, while loads act
  std::vector<std::optional<cloth::StepLengthControl>> lengths_;  // one per plan
  std::size_t plan_ = 0;
  std::optional<QualityController> controller_;
  std::optional<contact::ObstacleCollision> collision_;
  std::vector<contact::FreeBody> start_bodies_;  // of collision_
  std::vector<int> initially_attached_;
  CarryingFrames frames_;
  double time_step_;
  double last_duration_;  // s
  cloth::StepReport report_;
  AdaptiveReport adaptive_report_;
  bool last_step_rejected_ = false;
  std::uint64_t steps_ = 0;
  std::uint64_t computed_steps_ = 0;
  std::vector<char> fastened_;          // of state_
  std::vector<OpenedFastener> opened_;  // has the capacity of all
  bool disturbed_;                      // for ever, by an obstacle that moves
  cloth::RestDetector rest_;
  bool asleep_ = false;
};

}  // namespace haptex::simulation
