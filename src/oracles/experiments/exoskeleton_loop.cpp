#include "haptex/oracles/experiments/exoskeleton_loop.h"

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "haptex/exoskeleton/protocol/serial_port.h"

namespace haptex::oracles {

using namespace exoskeleton;
using Eigen::Vector3d;
using std::chrono::milliseconds;
using std::chrono::seconds;

namespace {

constexpr int kBitsPerByte = 10;  // start, eight data, stop

/// The driver's end of the lines.
class SimulatedPort final : public PortAccess {
 public:
  SimulatedPort(SimulatedLine& to_device, SimulatedLine& to_driver, const Time& now,
                const bool& open)
      : to_device_(to_device), to_driver_(to_driver), now_(now), open_(open) {}

  bool takeNew() override {
    if (is_there_ || !open_) return false;
    return is_there_ = true;
  }
  bool isThere() const override { return is_there_; }
  bool isClosed() const override { return !open_; }
  void discard() override {
    is_there_ = false;
    buffer_.clear();
  }
  std::size_t read(std::uint8_t* buffer, std::size_t capacity) override {
    const std::vector<std::uint8_t>& bytes = to_driver_.arrived(now_);
    const std::size_t kept = std::min(bytes.size(), kBuffer - std::min(kBuffer, buffer_.size()));
    buffer_.insert(buffer_.end(), bytes.begin(), bytes.begin() + kept);
    const std::size_t count = std::min(buffer_.size(), capacity);
    std::copy_n(buffer_.begin(), count, buffer);
    buffer_.erase(buffer_.begin(), buffer_.begin() + count);
    return count;
  }
  bool write(Bytes bytes) override {
    if (open_) to_device_.send(bytes, now_);
    return open_;
  }
  bool awaitBytes(Time) override { return false; }
  std::string trouble() const override { return is_there_ ? "" : "the simulated port is closed"; }
  const std::string& path() const override { return path_; }

 private:
  static constexpr std::size_t kBuffer = 65536;  // bytes that Linux keeps; what comes then is lost

  SimulatedLine& to_device_;
  SimulatedLine& to_driver_;
  const Time& now_;
  const bool& open_;
  const std::string path_ = "simulated";
  std::vector<std::uint8_t> buffer_;
  bool is_there_ = false;
};

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
