#include "haptex/exoskeleton/driver/driver_loop.h"

#include <algorithm>
#include <utility>

#include "haptex/realtime/steady_clock.h"
#include "haptex/serial/port_keeper.h"

namespace haptex::exoskeleton {

namespace {

/// A stamp that went through ROS's clock and back is not exact.
constexpr Time kStampError = std::chrono::microseconds(200);

unsigned bitOf(Finger finger) { return 1U << static_cast<unsigned>(finger); }

}  // namespace

FixedText::FixedText(const std::string& text) {
  std::copy_n(text.begin(), std::min(text.size(), kCapacity), characters_.begin());
}

DriverLoop::DriverLoop(std::unique_ptr<PortAccess> port, const std::string& urdf, Observer observer)
    : controller_(urdf), observer_(std::move(observer)), port_(std::move(port)) {}

DriverLoop::DriverLoop(const std::string& port, const std::string& urdf, Observer observer)
    : DriverLoop(std::make_unique<PortKeeper>(port), urdf, std::move(observer)) {}

void DriverLoop::tick(Time now) {
  begin(now);
  end(awaitAnswers(now));
  measurePath();
}

void DriverLoop::begin(Time now) {
  takePort();
  receive(now);
  controller_.observe(state_, now);
  snapshot_.operating_state = controller_.operatingState();
  for (const Finger finger : kFingers) snapshot_.fingers[finger] = controller_.measured(finger);
  if (state_ != nullptr && observer_) observer_(snapshot_);
}

bool DriverLoop::lacksAnswers(Time now) {
  takeCommands(now);
  return answersDue() != 0;
}

void DriverLoop::end(Time now) {
  takeCommands(now);
  DriverRequest request{};
  const bool asked = requests_.take(request);
  Refusal refusal;
  if (asked) refusal = carryOut(request);
  if (gravity_.update()) controller_.setGravity(gravity_.value().gravity, gravity_.value().at);
  const DeviceCommand& command = controller_.drive(now);
  send(link_.poll(now));
  send(link_.send(command));
  dropClosedPort();
  show();
  if (asked) requests_.answer(std::move(refusal));
}

void DriverLoop::takePort() {
  if (!port_->takeNew()) return;
  link_.reset();  // whoever answers there may be another device
}

void DriverLoop::receiveBytes(Time now) {
  if (!port_->isThere()) return;
  const std::size_t count = port_->read(received_.data(), received_.size());
  link_.receive(received_.data(), count, now);
}

void DriverLoop::receive(Time now) {
  receiveBytes(now);
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
      const StampedCommand& newest = box.newest.value();
      controller_.command(finger, newest.command, newest.arrival);
      answered_[finger] = newest.answers;
    }
    if (!died) continue;
    controller_.commanderDied(finger, now);
    answered_[finger] = Time{-1};  // nothing to wait for
  }
}

/// Fingers whose last states were answered and that lack the answer to this one, a bit for each.
unsigned DriverLoop::answersDue() const {
  if (state_ == nullptr) return 0;
  unsigned due = 0;
  for (const Finger finger : kFingers) {
    const Time answered = answered_[finger];
    const Time age = snapshot_.state_time - answered;
    if (answered >= Time{0} && age > kStampError && age <= kStillAnswering) due |= bitOf(finger);
  }
  return due;
}

/// @returns when it is now
Time DriverLoop::awaitAnswers(Time now) {
  const Time end = snapshot_.state_time + kAnswerPatience;
  bool in_time = true;
  while (in_time && lacksAnswers(now)) {
    answers_due_ = answersDue();
    if (!lacksAnswers(now)) break;  // what came before the bits were there
    in_time = answered_all_.waitUntil(end);
  }
  answers_due_ = 0;
  return std::max(now, realtime::steadyNow());
}

void DriverLoop::measurePath() {
  for (const Finger finger : kFingers) {
    const Time answered = answered_[finger];
    if (answered < Time{0} || answered <= path_end_[finger] + kStampError) continue;
    path_end_[finger] = answered;
    path_.add(realtime::steadyNow() - answered + kLine);
  }
}

bool DriverLoop::awaitState(Time until) {
  while (port_->isThere() && !port_->isClosed() && port_->awaitBytes(until)) {
    const Time now = realtime::steadyNow();
    receiveBytes(now);
    if (link_.hasState()) return true;
    if (port_->isClosed() || now >= until) break;
  }
  realtime::sleepUntil(until);
  return false;
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
  if (bytes.empty() || !port_->isThere()) return;
  if (!port_->write(bytes)) ++snapshot_.frames_unsent;
}

void DriverLoop::dropClosedPort() {
  if (!port_->isThere() || !port_->isClosed()) return;
  port_->discard();
  link_.reset();
  ++snapshot_.ports_lost;
  const OperatingState& state = controller_.operatingState();
  if (state.mode != Mode::kDisabled || state.is_busy) {
    controller_.raiseFault("the serial port was closed: unplugged, or its other end ended");
  }
}

void DriverLoop::show() {
  for (const Finger finger : kFingers) snapshot_.fingers[finger] = controller_.measured(finger);
  snapshot_.operating_state = controller_.operatingState();
  snapshot_.gravity = controller_.gravity();
  snapshot_.motors_on = controller_.motorsOn();
  snapshot_.fault = FixedText(controller_.fault());
  snapshot_.fault_is_a_stall = controller_.faultIsAStall();
  snapshot_.link = link_.status();
  snapshot_.link_statistics = link_.statistics();
  snapshot_.identity = link_.identity();
  snapshot_.port_open = port_->isThere();
  ++snapshot_.ticks;
  status_.write(snapshot_);
  if (state_ != nullptr) measured_.write(snapshot_);
}

void DriverLoop::command(Finger finger, const ForceCommand& command, Time arrival, Time answers) {
  CommandBox& box = commands_[finger];
  const std::lock_guard<std::mutex> lock(box.writers);
  box.newest.write({command, arrival, answers});
  // Woken up once, by the last one that is waited for.
  if (answers_due_.fetch_and(~bitOf(finger)) == bitOf(finger)) answered_all_.post();
}

DriverSnapshot DriverLoop::status() const {
  const std::lock_guard<std::mutex> lock(status_readers_);
  status_.update();
  return status_.value();
}

}  // namespace haptex::exoskeleton
