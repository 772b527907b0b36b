#include "haptex/oracles/experiments/exoskeleton_loop.h"

#include <memory>
#include <stdexcept>

#include "haptex/serial/serial_port.h"

namespace haptex::oracles {

using namespace exoskeleton;
using Eigen::Vector3d;
using std::chrono::milliseconds;
using std::chrono::seconds;

ExoskeletonLoop::ExoskeletonLoop(const std::string& urdf, unsigned seed,
                                 const FingerMechanics& mechanics)
    : device_(urdf, seed, mechanics),
      firmware_(Identity{}),
      to_device_(seed + 1, kFrameLayout, serial::kBaudRate),
      to_driver_(seed + 2, kFrameLayout, serial::kBaudRate),
      driver_(std::make_unique<SimulatedPort>(to_device_, to_driver_, now_, port_open_), urdf,
              [this](const DriverSnapshot& snapshot) { state_time_ = snapshot.state_time; }) {
  commandForce(Vector3d::Zero());
}

void ExoskeletonLoop::commandForce(const Vector3d& force) {
  ForceCommand command;
  command.force = force;
  commander_ = [command](Finger, Time) { return command; };
}

void ExoskeletonLoop::makeReady() {
  const auto accept = [](const Refusal& refusal) {
    if (!refusal.empty()) throw std::runtime_error("the exoskeleton refuses: " + refusal);
  };
  const auto wait_until = [&](const char* what, auto&& condition) {
    const Time end = now_ + seconds(20);
    while (!condition()) {
      if (now_ > end || controller().operatingState().mode == Mode::kFault) {
        throw std::runtime_error(std::string("the exoskeleton does not get ") + what + ": " +
                                 controller().fault());
      }
      step();
    }
  };
  wait_until("connected", [&] { return driver().link == LinkStatus::kConnected; });
  run(milliseconds(20));
  accept(ask(DriverRequest::kHome));
  wait_until("homed", [&] { return controller().operatingState().is_homed; });
  run(seconds(1));
  accept(ask(DriverRequest::kEnable));
  run(seconds(1));
}

void ExoskeletonLoop::run(Time duration, const Observer& observer) {
  for (const Time end = now_ + duration; now_ < end;) {
    step();
    if (observer) observer(*this);
  }
}

void ExoskeletonLoop::closePort() {
  port_open_ = false;
  to_device_.clear();
  to_driver_.clear();
}

void ExoskeletonLoop::killCommander() {
  commander_lives_ = false;
  for (const Finger finger : kFingers) driver_.commanderDied(finger);
}

void ExoskeletonLoop::step() {
  now_ += kStep;
  ++steps_;
  to_device_.advance(now_);
  to_driver_.advance(now_);
  stepDevice();
  if (!driver_lives_ || now_ < driver_stalls_until_) {
    if (steps_ % kStepsPerTick == kDriverPhase) stepCommander();
    return;
  }
  if (waited_ >= 0) {
    ++waited_;
    endDriver();
  }
  if (steps_ % kStepsPerTick == kDriverPhase) beginDriver();
}

void ExoskeletonLoop::stepDevice() {
  const std::vector<std::uint8_t>& bytes = to_device_.arrived(now_);
  firmware_.receive(bytes.data(), bytes.size(), now_);
  if (!driver_lives_ || !port_open_) firmware_.hangUp(now_);
  device_.step(motors_live_ ? firmware_.command(now_) : DeviceCommand{});
  if (!port_open_) return;
  to_driver_.send(firmware_.answer(), now_);
  if (steps_ % kStepsPerTick == 0) {
    to_driver_.send(firmware_.report(device_.read(), now_), now_);
  }
}

void ExoskeletonLoop::stepCommander() {
  if (commander_lives_ && now_ < commander_stalls_until_) return;
  if (!commander_lives_) {
    for (const Finger finger : kFingers) commands_[finger] = ForceCommand();
    return;
  }
  const bool hears = now_ >= measurements_stall_until_;
  if (hears) answered_ = state_time_;
  for (const Finger finger : kFingers) {
    if (hears) commands_[finger] = commander_(finger, now_);
    driver_.command(finger, commands_[finger], now_, answered_);
  }
}

void ExoskeletonLoop::beginDriver() {
  driver_.begin(now_);
  stepCommander();
  waited_ = 0;
  endDriver();
}

/// Unless the driver waits for answers.
void ExoskeletonLoop::endDriver() {
  if (waited_ < kPatience && driver_.lacksAnswers(now_)) return;
  waited_ = -1;
  driver_.end(now_);
}

LoopSample ExoskeletonLoop::sample(Finger finger) const {
  LoopSample sample;
  sample.time = now_;
  sample.commanded = commands_[finger].force;
  sample.desired = controller().measured(finger).desired_force;
  sample.motor_force = device_.truth(finger).motor_force;
  sample.contact_force = device_.truth(finger).contact_force;
  sample.mode = controller().operatingState().mode;
  sample.no_force = controller().measured(finger).no_force;
  sample.link = driver().link;
  return sample;
}

}  // namespace haptex::oracles
