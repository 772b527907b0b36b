#include "haptex/oracles/experiments/lines/contactor_drive.h"

#include <algorithm>
#include <memory>

#include "haptex/serial/line_descriptor.h"
#include "haptex/tactile/channel_sines.h"

namespace haptex::oracles {

using base::kFingers;

ContactorDrive::ContactorDrive(const tactile::Calibration& calibration, unsigned seed)
    : calibration_(calibration),
      to_device_(seed, tactile::kDriveLayout, serial::kBaudRate),
      to_driver_(seed + 1, tactile::kDriveLayout, serial::kBaudRate),
      firmware_(tactile::DriveIdentity{}),
      driver_(std::make_unique<SimulatedPort>(to_device_, to_driver_, now_, open_), calibration) {}

void ContactorDrive::killSource() {
  source_ = {};
  for (const base::Finger finger : kFingers) driver_.sourceDied(finger);
}

void ContactorDrive::killDriver(bool noticed) {
  driver_lives_ = false;
  hang_up_ = noticed;
}

void ContactorDrive::run(Time duration, const std::function<void()>& observe) {
  for (const Time end = now_ + duration; now_ < end;) {
    step();
    if (observe) observe();
  }
}

void ContactorDrive::serve() {
  if (now_ >= source_due_) {
    source_due_ += std::chrono::milliseconds(25);
    if (source_) {
      const Amplitudes amplitudes = source_(now_);
      for (const base::Finger finger : kFingers) driver_.receive(finger, amplitudes[finger], now_);
    }
  }
  if (driver_lives_ && now_ >= tick_due_) {
    tick_due_ += tactile::kDrivePeriod;
    driver_.tick(now_);
    sent_[sends_++ % sent_.size()] = driver_.command();
  }
}

void ContactorDrive::step() {
  now_ += kStep;
  serve();
  to_device_.advance(now_);
  to_driver_.advance(now_);
  const std::vector<std::uint8_t>& bytes = to_device_.arrived(now_);
  const std::uint64_t before = firmware_.obeyed();
  if (open_) firmware_.receive(bytes.data(), bytes.size(), now_);
  if (firmware_.obeyed() != before) compareObeyed(before);
  if (hang_up_) firmware_.hangUp(now_);
  if (!open_) return;
  to_driver_.send(firmware_.answer(), now_);
  if (now_ < report_due_) return;
  report_due_ = now_ + tactile::kDrivePeriod;
  to_driver_.send(firmware_.report(now_), now_);
}

/// Counts what the electronics obey and the driver had not sent, as the line rounds both.
/// @param before firmware_.obeyed() at the last look
void ContactorDrive::compareObeyed(std::uint64_t before) {
  const auto inSteps = [](const tactile::DriveCommand& command) {
    serial::FrameBuffer buffer;
    const serial::Bytes bytes = encode(command, 0, buffer);
    return std::vector<std::uint8_t>(bytes.data, bytes.data + bytes.size);
  };
  // Of several that came at once only the last is to be seen.
  const std::vector<std::uint8_t> obeyed = inSteps(firmware_.command());
  const bool known =
      std::any_of(sent_.begin(), sent_.end(),
                  [&](const tactile::DriveCommand& command) { return inSteps(command) == obeyed; });
  if (!known) wrongly_obeyed_ += static_cast<int>(firmware_.obeyed() - before);
}

bool ContactorDrive::moves() const {
  const auto drive = firmware_.drive(now_);
  for (const base::Finger finger : kFingers) {
    for (const tactile::PerChannel<double>& shares : drive[finger]) {
      if (shares[tactile::k40] != 0.0 || shares[tactile::k320] != 0.0) return true;
    }
  }
  return false;
}

double displacement(const tactile::PerChannel<double>& amplitudes, long long sample,
                    double sample_rate) {
  const tactile::PerChannel<double> sines = tactile::sinesAt(sample, sample_rate);
  return amplitudes[tactile::k40] * sines[tactile::k40] +
         amplitudes[tactile::k320] * sines[tactile::k320];
}

}  // namespace haptex::oracles
