#include "haptex/oracles/experiments/exoskeleton_loop.h"

#include <algorithm>
#include <stdexcept>

#include "haptex/exoskeleton/protocol/serial_port.h"

namespace haptex::oracles {

using namespace exoskeleton;
using Eigen::Vector3d;
using std::chrono::milliseconds;
using std::chrono::seconds;

namespace {

constexpr int kBitsPerByte = 10;  // start, eight data, stop

}  // namespace

void SimulatedLine::advance(Time now) {
  const Time byte_time =
      std::chrono::nanoseconds(std::chrono::nanoseconds::period::den * kBitsPerByte / baud_rate_);
  const Bytes bytes = faults_.arrived(now);
  for (std::size_t i = 0; i < bytes.size; ++i) {
    free_at_ = std::max(free_at_, now) + byte_time;
    on_its_way_.emplace_back(free_at_, bytes.data[i]);
  }
}

const std::vector<std::uint8_t>& SimulatedLine::arrived(Time now) {
  arrived_.clear();
  while (!on_its_way_.empty() && on_its_way_.front().first <= now) {
    arrived_.push_back(on_its_way_.front().second);
    on_its_way_.pop_front();
  }
  return arrived_;
}

ExoskeletonLoop::ExoskeletonLoop(const std::string& urdf, unsigned seed,
                                 const FingerMechanics& mechanics)
    : device_(urdf, seed, mechanics),
      firmware_(Identity{}),
      to_device_(seed + 1, exoskeleton::kBaudRate),
      to_driver_(seed + 2, exoskeleton::kBaudRate),
      controller_(urdf) {
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
  const auto waitUntil = [&](const char* what, auto&& condition) {
    const Time end = now_ + seconds(20);
    while (!condition()) {
      if (now_ > end || controller_.operatingState().mode == Mode::kFault) {
        throw std::runtime_error(std::string("the exoskeleton does not get ") + what + ": " +
                                 controller_.fault());
      }
      step();
    }
  };
  waitUntil("connected", [&] { return link_.status() == LinkStatus::kConnected; });
  run(milliseconds(20));
  accept(controller_.home());
  waitUntil("homed", [&] { return controller_.operatingState().is_homed; });
  run(seconds(1));
  accept(controller_.enable());
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
  if (!driver_lives_) return;
  link_.reset();
  controller_.raiseFault("the port is closed");
}

void ExoskeletonLoop::step() {
  now_ += kStep;
  ++steps_;
  to_device_.advance(now_);
  to_driver_.advance(now_);
  stepDevice();
  if (steps_ % kStepsPerTick != kDriverPhase) return;
  stepCommander();
  stepDriver();
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
  for (const Finger finger : kFingers) {
    commanded_[finger].setZero();
    if (!commander_lives_) continue;
    const ForceCommand command = commander_(finger, now_);
    commanded_[finger] = command.force;
    arrivals_[finger] = {command, now_, true};
  }
}

void ExoskeletonLoop::takeCommands() {
  for (const Finger finger : kFingers) {
    Arrival& arrival = arrivals_[finger];
    if (arrival.is_new) controller_.command(finger, arrival.command, arrival.time);
    arrival.is_new = false;
    if (!commander_lives_ && !death_is_known_) controller_.commanderDied(finger, now_);
  }
  death_is_known_ = !commander_lives_;
}

void ExoskeletonLoop::stepDriver() {
  if (driver_lives_ && now_ < driver_stalls_until_) return;
  const std::vector<std::uint8_t>& bytes = to_driver_.arrived(now_);
  if (!driver_lives_) return;
  link_.receive(bytes.data(), bytes.size(), now_);
  takeCommands();
  const DeviceCommand& command = controller_.tick(link_.takeState(), now_);
  if (!port_open_) return;
  to_device_.send(link_.poll(now_), now_);
  to_device_.send(link_.send(command), now_);
}

LoopSample ExoskeletonLoop::sample(Finger finger) const {
  LoopSample sample;
  sample.time = now_;
  sample.commanded = commanded_[finger];
  sample.desired = controller_.measured(finger).desired_force;
  sample.motor_force = device_.truth(finger).motor_force;
  sample.contact_force = device_.truth(finger).contact_force;
  sample.mode = controller_.operatingState().mode;
  sample.no_force = controller_.measured(finger).no_force;
  sample.link = link_.status();
  return sample;
}

}  // namespace haptex::oracles
