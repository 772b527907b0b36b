#include "haptex/tactile/drive/array_driver.h"

#include <algorithm>

namespace haptex::tactile {

using base::kFingers;
using base::seconds;

void ArrayDriver::receive(Finger finger, const ArrayAmplitudes& amplitudes, Time now) {
  Source& source = sources_[finger];
  source.from = this->amplitudes(finger, now);
  source.to = amplitudes;
  source.arrival = now;
}

bool ArrayDriver::isDriven(Finger finger, Time now) const {
  const std::optional<Time>& arrival = sources_[finger].arrival;
  return arrival && now - *arrival < kSilence;
}

ArrayAmplitudes ArrayDriver::amplitudes(Finger finger, Time now) const {
  return isDriven(finger, now) ? onTheWay(sources_[finger], now) : ArrayAmplitudes{};
}

ArrayAmplitudes ArrayDriver::onTheWay(const Source& source, Time now) {
  const double way = std::clamp(seconds(now - *source.arrival) / kTactileStep, 0.0, 1.0);
  ArrayAmplitudes amplitudes;
  for (int i = 0; i < kContactors; ++i) {
    for (const Channel channel : {k40, k320}) {
      const double from = source.from[i][channel];
      amplitudes[i][channel] = from + way * (source.to[i][channel] - from);
    }
  }
  return amplitudes;
}

void ArrayDriver::tick(Time now) {
  takePort();
  receiveBytes(now);
  send(link_.poll(now));
  // What the electronics reach when the next command comes.
  for (const Finger finger : kFingers) {
    command_.drive[finger] =
        isDriven(finger, now)
            ? driveFor(onTheWay(sources_[finger], now + kDrivePeriod), calibration_[finger])
            : ArrayDrive{};
  }
  const serial::Bytes bytes = link_.send(command_);
  if (!bytes.empty()) ++status_.commands;
  send(bytes);
  dropClosedPort();
  status_.link = link_.status();
  status_.link_statistics = link_.statistics();
  status_.identity = link_.identity();
  status_.port_open = port_->isThere();
}

void ArrayDriver::takePort() {
  if (port_->takeNew()) link_.reset();
}

void ArrayDriver::receiveBytes(Time now) {
  if (!port_->isThere()) return;
  std::size_t count = 0;
  do {
    count = port_->read(received_.data(), received_.size());
    link_.receive(received_.data(), count, now);
  } while (count == received_.size());
  if (const DriveState* state = link_.takeState()) {
    if (state->watchdog_tripped && !status_.watchdog_tripped) ++status_.watchdog_trips;
    status_.watchdog_tripped = state->watchdog_tripped;
  }
}

void ArrayDriver::send(serial::Bytes bytes) {
  if (bytes.empty() || !port_->isThere() || port_->isClosed()) return;
  if (!port_->write(bytes)) ++status_.frames_unsent;
}

void ArrayDriver::dropClosedPort() {
  if (!port_->isThere() || !port_->isClosed()) return;
  port_->discard();
  link_.reset();
  ++status_.ports_lost;
}

}  // namespace haptex::tactile
