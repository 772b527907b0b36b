// The exoskeleton's driver without ROS: what happens once per millisecond between the port and
// those who command forces, make requests and look at what was measured.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "haptex/exoskeleton/control/device_controller.h"
#include "haptex/exoskeleton/driver/request_box.h"
#include "haptex/exoskeleton/protocol/device_link.h"
#include "haptex/realtime/duration_histogram.h"
#include "haptex/realtime/ring.h"
#include "haptex/realtime/semaphore.h"
#include "haptex/realtime/triple_buffer.h"
#include "haptex/serial/port_access.h"
#include "haptex/serial/port_keeper.h"

namespace haptex::exoskeleton {

using serial::PortAccess;
using serial::PortKeeper;

/// A text that is copied without allocating; its end is cut off if it is too long.
class FixedText {
 public:
  static constexpr std::size_t kCapacity = 255;

  FixedText() = default;
  explicit FixedText(const std::string& text);

  std::string str() const { return characters_.data(); }
  bool operator==(const FixedText& other) const { return characters_ == other.characters_; }

 private:
  std::array<char, kCapacity + 1> characters_{};
};

/// What the driver knows after a tick.
struct DriverSnapshot {
  Time state_time{0};  ///< when the newest state of the device was received
  PerFinger<FingerMeasurement> fingers;
  OperatingState operating_state;
  Eigen::Vector3d gravity =
      Eigen::Vector3d::Zero();    ///< m/s^2, in hand_base, held against; zero: not known
  bool motors_on = false;         ///< by the last command
  FixedText fault;                ///< what latched the fault; empty without one
  bool fault_is_a_stall = false;  ///< the device was silent for a moment
  LinkStatus link = LinkStatus::kConnecting;
  LinkStatistics link_statistics;
  Identity identity;
  bool port_open = false;
  // Counts since the construction, no units.
  std::uint64_t ticks = 0;
  std::uint64_t states = 0;         ///< of the device, taken
  std::uint64_t ports_lost = 0;     ///< times an open port was found closed
  std::uint64_t frames_unsent = 0;  ///< which the line did not take in time
};

/// Owns port, link and controller. One thread ticks, any others do the rest; tick() waits for none
/// of them, but for kAnswerPatience at most for the forces that answer the state that has come, if
/// those of the states before were answered. It does not allocate, but for the answer to a refused
/// request and for the text of a fault.
class DriverLoop {
 public:
  static constexpr Time kPeriod = std::chrono::milliseconds(1);
  /// After a state. A force that comes later is rendered in the next period.
  static constexpr Time kAnswerPatience = std::chrono::microseconds(720);
  /// Forces that answered a state of this age or a younger one promise to answer the next.
  static constexpr Time kStillAnswering = std::chrono::milliseconds(5);
  /// Both ways on the line, for path(): a pseudo-terminal takes no time for them.
  static constexpr Time kLine = std::chrono::microseconds(760);

  /// On the thread that ticks, as soon as a state has been measured: must not wait.
  using Observer = std::function<void(const DriverSnapshot&)>;

  /// Times are those of steadyNow().
  /// @param port path of a serial port, which need not be there yet (PortKeeper)
  /// @param urdf text of the exoskeleton's URDF
  /// @throws std::invalid_argument as exoskeleton::FingerKinematics
  DriverLoop(const std::string& port, const std::string& urdf, Observer observer = {});

  /// Times are the caller's, who calls begin() and end() instead of tick() and awaitState().
  DriverLoop(std::unique_ptr<PortAccess> port, const std::string& urdf, Observer observer = {});

  /// By one thread, once per kPeriod: states in, commands and requests, torques out.
  void tick(Time now);

  // tick() is: begin(), as long as lacksAnswers() wait for kAnswerPatience after the state at most,
  // end().
  void begin(Time now);
  bool lacksAnswers(Time now);
  void end(Time now);

  /// By the same thread, between two ticks: as ask().
  Refusal carryOut(DriverRequest request);
  /// By the same thread.
  const DeviceController& controller() const { return controller_; }
  DeviceController& controller() { return controller_; }

  /// By the same thread, between two ticks: waits for the next state of the device.
  /// @returns false if none came until then
  bool awaitState(Time until);

  /// By any thread: the newest commanded force of a finger, for the next tick.
  /// @param arrival when it came
  /// @param answers  when the state came that it was computed from; negative: not known
  void command(Finger finger, const ForceCommand& command, Time arrival, Time answers = Time{-1});

  /// By one thread: which way gravity (m/s^2, in hand_base) pulls, for the next tick.
  /// @param at when it was so, see HandGravity
  void setGravity(const Eigen::Vector3d& gravity, Time at) { gravity_.write({gravity, at}); }

  /// By any thread: from a state of the device to the torques that answer it, for every finger and
  /// state that was answered, with kLine.
  const realtime::DurationHistogram& path() const { return path_; }

  /// By any thread: the one who commanded this finger is dead, see DeviceController. A command that
  /// came before is older.
  void commanderDied(Finger finger) { commands_[finger].died = true; }

  /// By any thread: asks between two ticks. See RequestBox::ask(). After it status() shows what it
  /// led to.
  Refusal ask(DriverRequest request) { return requests_.ask(request); }

  /// By one thread: the oldest snapshot not yet taken of a tick in which a state came, waiting for
  /// one if there is none. Those are kept for 64 ms, then newer ones are lost.
  /// @returns false if none came in time
  bool takeMeasured(DriverSnapshot& snapshot, Time patience) {
    return measured_.read(snapshot, patience);
  }
  /// By any thread: snapshots that nobody took in time.
  std::uint64_t lostSnapshots() const { return measured_.lost(); }

  /// By any thread: what is known after the last tick.
  DriverSnapshot status() const;

  /// By any thread: why there is no open port; empty while there is one.
  std::string portTrouble() const { return port_->trouble(); }
  const std::string& port() const { return port_->path(); }

 private:
  struct StampedCommand {
    ForceCommand command;
    Time arrival{0};
    Time answers{-1};
  };
  struct StampedGravity {
    Eigen::Vector3d gravity = Eigen::Vector3d::Zero();
    Time at{0};
  };
  struct CommandBox {
    std::mutex writers;  // guards writing; never taken by the loop
    realtime::TripleBuffer<StampedCommand> newest;
    std::atomic<bool> died{false};  // the commander has, after the newest
  };

  void takePort();
  void receiveBytes(Time now);
  void receive(Time now);
  void takeCommands(Time now);
  unsigned answersDue() const;
  Time awaitAnswers(Time now);
  void measurePath();
  void send(Bytes bytes);
  void dropClosedPort();
  void show();

  // Touched by the thread that ticks only.
  DeviceController controller_;
  DeviceLink link_;
  const DeviceState* state_ = nullptr;  // of this tick; nullptr if none came
  DriverSnapshot snapshot_;
  std::array<std::uint8_t, 4096> received_{};  // more than a line brings in 40 ms
  Observer observer_;
  PerFinger<Time> answered_{{{Time{-1}, Time{-1}}}};  // states, by the last command
  PerFinger<Time> path_end_{{{Time{-1}, Time{-1}}}};  // those in path_
  realtime::DurationHistogram path_;

  // Between threads.
  std::unique_ptr<PortAccess> port_;
  RequestBox requests_;
  PerFinger<CommandBox> commands_;
  realtime::TripleBuffer<StampedGravity> gravity_;
  std::atomic<unsigned> answers_due_{0};  // a bit per finger, for which the loop waits
  realtime::Semaphore answered_all_;
  realtime::Ring<DriverSnapshot, 64> measured_;
  mutable std::mutex status_readers_;  // guards reading; never taken by the loop
  mutable realtime::TripleBuffer<DriverSnapshot> status_;
};

}  // namespace haptex::exoskeleton
