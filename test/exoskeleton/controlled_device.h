// The device controller in a closed loop with two emulated fingers, over a line that delays.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <functional>
#include <optional>
#include <random>
#include <string>

#include "haptex/exoskeleton/control/device_controller.h"
#include "haptex/exoskeleton/emulator/emulated_finger.h"
#include "shipped_urdf.h"

namespace haptex::exoskeleton {

/// Tenths of the work of the long tests that are done: one with sanitizers, which are ten times as
/// slow.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr int kThoroughness = 1;
#else
constexpr int kThoroughness = 10;
#endif

/// Ticks of 1 ms. Encoders and force sensors as EmulatedDevice has them, but with mechanics that a
/// test chooses, and fingers that it may put anywhere.
struct ControlledDevice {
  static constexpr int kSubsteps = 8;

  /// @param state_delay, command_delay in ticks; what a line takes
  explicit ControlledDevice(const FingerMechanics& mechanics = {}, std::size_t state_delay = 1,
                            std::size_t command_delay = 1)
      : fingers{{EmulatedFinger(shippedUrdf(), Finger::kIndex, mechanics),
                 EmulatedFinger(shippedUrdf(), Finger::kThumb, mechanics)}},
        controller(shippedUrdf()),
        state_delay(state_delay),
        commands_on_the_way(command_delay) {}

  DeviceState read() {
    DeviceState state;
    state.time = clock_offset + static_cast<std::uint32_t>(now.count() / 1000);
    state.last_command = last_command;
    for (const Finger finger : kFingers) {
      const EmulatedFinger& emulated = fingers[finger];
      for (int i = 0; i < kMotors; ++i) {
        state.fingers[finger].encoder_counts[i] = static_cast<std::int32_t>(
            std::lround(emulated.motorAngles()[i] * kCountsPerRevolution / (2.0 * M_PI)) +
            count_offset);
      }
      Eigen::Vector3d force = emulated.thimble().linear().transpose() * emulated.contactForce();
      for (int i = 0; i < 3; ++i) force[i] += noise(generator);
      state.fingers[finger].force = kForceStep * (force / kForceStep).array().round();
    }
    if (spoil) spoil(state);
    return state;
  }

  /// One period of everything.
  void tick() {
    now += std::chrono::milliseconds(1);
    states_on_the_way.push_back(read());
    std::optional<DeviceState> state;
    if (states_on_the_way.size() > state_delay) {
      if (states_arrive) state = states_on_the_way.front();
      states_on_the_way.pop_front();
    }
    for (const Finger finger : kFingers) {
      if (wanted[finger]) controller.command(finger, *wanted[finger], now);
    }
    commands_on_the_way.push_back(controller.tick(state ? &*state : nullptr, now));
    if (commands_arrive) obeyed = commands_on_the_way.front();
    if (commands_arrive) ++last_command;
    commands_on_the_way.pop_front();
    for (int i = 0; i < kSubsteps; ++i) {
      for (const Finger finger : kFingers) {
        EmulatedFinger& emulated = fingers[finger];
        emulated.relax(obeyed.mode == DriveMode::kHoming);
        emulated.step(obeyed.mode == DriveMode::kOff ? MotorVector::Zero() : obeyed.torques[finger],
                      1.0 / (1000.0 * kSubsteps));
      }
    }
  }

  void run(double duration) {
    for (int i = 0; i < static_cast<int>(std::lround(1000.0 * duration)); ++i) tick();
  }

  /// Until it is homed, enabled and the soft start is over. @returns false if it is refused
  bool start() {
    run(0.05);
    if (!controller.home().empty()) return false;
    for (int i = 0; i < 12000 && controller.operatingState().is_busy; ++i) tick();
    run(0.6);  // the person takes the fingers back
    if (!controller.enable().empty()) return false;
    run(0.6);
    return true;
  }

  /// At rest at these motor angles, where the person wants to be.
  void place(Finger finger, const MotorVector& angles) { fingers[finger].place(angles); }

  void want(Finger finger, const Eigen::Vector3d& force) {
    ForceCommand command;
    command.force = force;
    wanted[finger] = command;
  }

  PerFinger<EmulatedFinger> fingers;
  DeviceController controller;
  Time now{0};
  PerFinger<std::optional<ForceCommand>> wanted;  ///< sent in every period
  bool states_arrive = true;
  bool commands_arrive = true;
  int count_offset = 100000;
  std::uint32_t clock_offset = 0;           ///< us
  std::function<void(DeviceState&)> spoil;  ///< changes what the device says
  DeviceCommand obeyed;
  std::uint8_t last_command = 0;
  std::mt19937 generator{7};
  std::normal_distribution<double> noise{0.0, 0.002};
  std::size_t state_delay;
  std::deque<DeviceState> states_on_the_way;
  std::deque<DeviceCommand> commands_on_the_way;
};

const Eigen::Vector3d kDown(0.0, 0.6, -0.8);

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Enabled, past the soft start, with these forces (N) on both fingers for a second.
inline ControlledDevice rendering(const Eigen::Vector3d& force) {
  ControlledDevice device;
  EXPECT_TRUE(device.start()) << device.controller.fault();
  for (const Finger finger : kFingers) device.want(finger, force);
  device.run(1.0);
  return device;
}

inline NoForceReason reason(const ControlledDevice& device, Finger finger = Finger::kIndex) {
  return device.controller.measured(finger).no_force;
}

/// N, norm of the desired force.
inline double desired(const ControlledDevice& device, Finger finger = Finger::kIndex) {
  return device.controller.measured(finger).desired_force.norm();
}

}  // namespace haptex::exoskeleton
