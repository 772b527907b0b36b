#include "haptex/nodes/driver_loop.h"

#include <algorithm>
#include <utility>

namespace haptex::nodes {

using exoskeleton::Bytes;
using exoskeleton::Finger;
using exoskeleton::kFingers;
using exoskeleton::Mode;
using exoskeleton::Refusal;

FixedText::FixedText(const std::string& text) {
  std::copy_n(text.begin(), std::min(text.size(), kCapacity), characters_.begin());
}

DriverLoop::DriverLoop(const std::string& port, const std::string& urdf)
    : controller_(urdf), ports_(port) {}

void DriverLoop::tick(Time now) {
  takePort();
  receive(now);
  takeCommands(now);
  DriverRequest request{};
  const bool asked = requests_.take(request);
  Refusal refusal;
  if (asked) refusal = carryOut(request);
  const exoskeleton::DeviceCommand& command = controller_.tick(state_, now);
  send(link_.poll(now));
  send(link_.send(command));
  dropClosedPort();
  show();
  if (asked) requests_.answer(std::move(refusal));
}

void DriverLoop::takePort() {
  if (!ports_.takeNew()) return;
  link_.reset();  // whoever answers there may be another device
}

void DriverLoop::receive(Time now) {
  if (ports_.port() != nullptr) {
    const std::size_t count = ports_.port()->read(received_.data(), received_.size());
    link_.receive(received_.data(), count, now);
  }
  state_ = link_.takeState();
  if (state_ == nullptr) return;
  snapshot_.state_time = now;
  ++snapshot_.states;
}

void DriverLoop::takeCommands(Time now) {
  for (const Finger finger : kFingers) {
    CommandBox& box = commands_[finger];
    const bool died = box.died.exchange(false);  // first: a command after it is another one's
    if (box.newest.update()) {
      controller_.command(finger, box.newest.value().command, box.newest.value().arrival);
    }
    if (died) controller_.commanderDied(finger, now);
  }
}

Refusal DriverLoop::carryOut(DriverRequest request) {
  switch (request) {
    case DriverRequest::kEnable:
      return controller_.enable();
    case DriverRequest::kDisable:
      return controller_.disable();
    case DriverRequest::kPause:
      return controller_.pause();
    case DriverRequest::kHome:
      return controller_.home();
    case DriverRequest::kClearFault:
      return controller_.clearFault();
  }
  return "unknown request";
}

void DriverLoop::send(Bytes bytes) {
  if (bytes.empty() || ports_.port() == nullptr) return;
  if (!ports_.port()->write(bytes)) ++snapshot_.frames_unsent;
}

void DriverLoop::dropClosedPort() {
  if (ports_.port() == nullptr || !ports_.port()->closed()) return;
  ports_.discard();
  link_.reset();
  ++snapshot_.ports_lost;
  const exoskeleton::OperatingState& state = controller_.operatingState();
  if (state.mode != Mode::kDisabled || state.is_busy) {
    controller_.raiseFault("the serial port was closed: unplugged, or its other end ended");
  }
}

void DriverLoop::show() {
  for (const Finger finger : kFingers) snapshot_.fingers[finger] = controller_.measured(finger);
  snapshot_.operating_state = controller_.operatingState();
  snapshot_.fault = FixedText(controller_.fault());
  snapshot_.fault_is_a_stall = controller_.faultIsAStall();
  snapshot_.link = link_.status();
  snapshot_.link_statistics = link_.statistics();
  snapshot_.identity = link_.identity();
  snapshot_.port_open = ports_.port() != nullptr;
  ++snapshot_.ticks;
  status_.write(snapshot_);
  if (state_ != nullptr) measured_.write(snapshot_);
}

void DriverLoop::command(Finger finger, const exoskeleton::ForceCommand& command, Time arrival) {
  CommandBox& box = commands_[finger];
  const std::lock_guard<std::mutex> lock(box.writers);
  box.newest.write({command, arrival});
}

DriverSnapshot DriverLoop::status() const {
  const std::lock_guard<std::mutex> lock(status_readers_);
  status_.update();
  return status_.value();
}

}  // namespace haptex::nodes
