// The mechanics and electronics of the emulated exoskeleton on a person's hand.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <random>
#include <string>

#include "haptex/exoskeleton/emulator/emulated_finger.h"
#include "haptex/exoskeleton/finger.h"
#include "haptex/exoskeleton/protocol/device_messages.h"

namespace haptex::exoskeleton {

/// What no device can know of itself, for tests and plots, in hand_base.
struct EmulatedTruth {
  MotorVector motor_angles = MotorVector::Zero();           ///< rad
  Eigen::Vector3d position = Eigen::Vector3d::Zero();       ///< m, of the fingertip
  Eigen::Vector3d contact_force = Eigen::Vector3d::Zero();  ///< N, by the device on the fingertip
  Eigen::Vector3d motor_force =
      Eigen::Vector3d::Zero();  ///< N, what the motor torques give there at rest
};

/// Motors, transmissions, linkages and a finger in each, integrated at kRate. Reproducible: noise
/// comes from a seeded generator. step() and read() do not allocate.
class EmulatedDevice {
 public:
  static constexpr double kRate = 8000.0;  ///< Hz
  /// N m, what the current limit leaves of each motor's torque: representative.
  static constexpr double kMaxTorque = 0.06;
  /// The force sensor of each component: its range is -kForceRange to kForceRange (N), its noise is
  /// normal with this standard deviation (N). Both are representative.
  static constexpr double kForceRange = 10.0;
  static constexpr double kForceNoise = 0.002;
  /// N along z of the fingertip, what the vibrations of the contactors of 40 and of 320 Hz add to
  /// the sensor's force while it is asked for: 20 um against the pulp's stiffness, and 24
  /// contactors of 0.1 g that move by 5 um. Representative.
  static constexpr double kSlowVibration = 0.02, kFastVibration = 0.05;
  /// Fingers do not pass through each other: below this distance (m) of their middles they push
  /// each other apart with this stiffness (N/m). Bones with compressed pulp: representative.
  static constexpr double kClosest = 0.008;
  static constexpr double kBoneStiffness = 3000.0;

  /// @param urdf text of the exoskeleton's URDF: geometry, masses, limits
  /// @param mechanics of both fingers
  /// @throws std::invalid_argument as FingerKinematics
  EmulatedDevice(const std::string& urdf, unsigned seed, const FingerMechanics& mechanics = {});

  /// Where the person moves the fingertip to (m, in hand_base), from the next step on. A target out
  /// of reach is replaced by the nearest one that the finger can reach.
  /// Not finite: ignored.
  void setTarget(Finger finger, const Eigen::Vector3d& target);

  /// How the hand is held (hand_base in world, z up), from the next step on: turns gravity. What
  /// turns with a hand at 90 degrees/s weighs 3 % more at most; that is left out. Not finite:
  /// ignored.
  void turnHand(const Eigen::Matrix3d& rotation);

  /// One period of kRate under a command. While its mode is DriveMode::kHoming the person lets the
  /// fingers be moved. Torques of a finger that are not finite are taken as zero.
  void step(const DeviceCommand& command);

  /// What encoders and force sensors say now. time counts the steps.
  DeviceState read();

  /// A component reads the end of the range of the sensor (fault).
  void saturateSensor(Finger finger, bool saturated);

  /// The contactors shake the sensors of both fingers, or no longer; not at first.
  void shakeSensors(bool shaken) { sensors_shaken_ = shaken; }

  const EmulatedTruth& truth(Finger finger) const { return fingers_[finger].truth; }
  const EmulatedFinger& finger(Finger finger) const { return fingers_[finger].dynamics; }

 private:
  void keepApart();

  struct EmulatedSide {
    EmulatedSide(const std::string& urdf, Finger finger, const FingerMechanics& mechanics)
        : dynamics(urdf, finger, mechanics) {}

    EmulatedFinger dynamics;
    MotorVector switched_on_at = MotorVector::Zero();  // rad, where the encoders count from
    bool sensor_saturated = false;
    EmulatedTruth truth;

    void updateTruth(const MotorVector& torques);
  };

  FingerReading reading(const EmulatedSide& side);

  PerFinger<EmulatedSide> fingers_;
  std::mt19937 generator_;
  std::normal_distribution<double> noise_{0.0, kForceNoise};
  std::uint64_t steps_ = 0;
  bool sensors_shaken_ = false;
};

}  // namespace haptex::exoskeleton
