#include "haptex/tactile/drive/emulated_electronics.h"

#include <stdexcept>

#include "haptex/tactile/channel_sines.h"

namespace haptex::tactile {
namespace {

using base::Finger;
using base::kFingers;
using base::Time;

constexpr auto kMostSamples = static_cast<long long>(kLongestSound * kSoundRate);
constexpr Time kFlushPeriod = std::chrono::seconds(1);

DriveIdentity identity() {
  DriveIdentity identity;
  identity.firmware = 1;
  identity.serial_number = 1;
  return identity;
}

Time timeOf(long long sample) { return Time{sample * Time::period::den / kSoundRate}; }

}  // namespace

EmulatedElectronics::EmulatedElectronics(const std::string& link, const Calibration& calibration,
                                         const std::optional<PlayedContactor>& played)
    : calibration_(calibration), line_(link, kDriveLayout), firmware_(identity()) {
  if (!played) return;
  played_ = *played;
  sound_.emplace(played->path);
}

void EmulatedElectronics::advanceTo(Time now) {
  if (sound_) play(now);
  const serial::Bytes received = line_.receive(now);
  firmware_.receive(received.data, received.size, now);
  if (!line_.isConnected()) firmware_.hangUp(now);
  line_.send(firmware_.answer(), now);
  if (!report_due_ || now >= *report_due_) {
    line_.send(firmware_.report(now), now);
    report_due_ = now + kDrivePeriod;
  }
  line_.flush(now);
  const bool tripped = firmware_.watchdogTripped(now);
  if (tripped && !tripped_) ++watchdog_trips_;
  tripped_ = tripped;
}

base::PerFinger<ArrayAmplitudes> EmulatedElectronics::amplitudes(Time now) const {
  const base::PerFinger<ArrayDrive> drive = firmware_.drive(now);
  base::PerFinger<ArrayAmplitudes> amplitudes;
  for (const Finger finger : kFingers) {
    amplitudes[finger] = amplitudesOf(drive[finger], calibration_[finger]);
  }
  return amplitudes;
}

/// Before what has come now is obeyed: the samples are those of the time before.
void EmulatedElectronics::play(Time now) {
  try {
    addSamples(now);
    if (now < flush_due_) return;
    flush_due_ = now + kFlushPeriod;
    sound_->flush();
    if (sample_ < kMostSamples) return;
    sound_->close();
    throw std::runtime_error(played_.path + ": is " +
                             std::to_string(static_cast<int>(kLongestSound)) +
                             " s long, the most that is written");
  } catch (const std::runtime_error& error) {  // of the file: the electronics go on
    sound_trouble_ = error.what();
    sound_.reset();
  }
}

void EmulatedElectronics::addSamples(Time until) {
  if (!sound_start_ || until - (*sound_start_ + timeOf(sample_)) > kMaxLag) {
    sound_start_ = until - timeOf(sample_);
  }
  const PerChannel<double>& full =
      calibration_[played_.finger][played_.contactor].full_displacement;
  for (Time time = *sound_start_ + timeOf(sample_); time < until && sample_ < kMostSamples;
       time = *sound_start_ + timeOf(++sample_)) {
    const PerChannel<double> sines = sinesAt(sample_, kSoundRate);
    const PerChannel<double> drive = firmware_.drive(played_.finger, played_.contactor, time);
    sound_->add(full[k40] * drive[k40] * sines[k40] + full[k320] * drive[k320] * sines[k320]);
  }
}

}  // namespace haptex::tactile
