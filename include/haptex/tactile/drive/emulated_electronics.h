// The drive electronics of the contactors without hardware: their firmware behind a serial line
// with faults on demand, and what the contactors do. Knows no ROS and reads no clock.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "haptex/base/clock.h"
#include "haptex/base/finger.h"
#include "haptex/serial/emulated_line.h"
#include "haptex/serial/emulator_fault.h"
#include "haptex/tactile/drive/calibration.h"
#include "haptex/tactile/drive/drive_firmware.h"
#include "haptex/tactile/sound_file.h"

namespace haptex::tactile {

/// What one contactor does, written as a sound.
struct PlayedContactor {
  std::string path;  ///< of the WAV file
  base::Finger finger = base::Finger::kIndex;
  int contactor = 0;  ///< below kContactors
};

/// By one thread.
class EmulatedElectronics {
 public:
  using Time = base::Time;

  /// A sound that falls behind by more, after a stall, goes on from now. It ends after
  /// kLongestSound.
  static constexpr Time kMaxLag = std::chrono::milliseconds(100);

  /// @param link symbolic link to the port, see PseudoTerminal
  /// @param calibration how far these contactors move for how much drive
  /// @throws std::runtime_error as PseudoTerminal, and as SoundFile
  EmulatedElectronics(const std::string& link, const Calibration& calibration,
                      const std::optional<PlayedContactor>& played = {});

  /// Lives from the last call until now. To be called every few milliseconds.
  void advanceTo(Time now);

  void inject(const serial::EmulatorFault& fault, Time now) { line_.inject(fault, now); }

  /// Amplitudes of the contactors' displacements now, m.
  base::PerFinger<ArrayAmplitudes> amplitudes(Time now) const;

  const DriveFirmware& firmware() const { return firmware_; }
  const serial::EmulatedLine& line() const { return line_; }
  std::uint64_t watchdogTrips() const { return watchdog_trips_; }
  /// Why the sound ended, naming its file; empty as long as it does not.
  const std::string& soundTrouble() const { return sound_trouble_; }
  /// Nothing unless a contactor is played.
  const WrittenSound* sound() const { return sound_ ? &sound_->written() : nullptr; }

 private:
  void play(Time now);
  void addSamples(Time until);

  Calibration calibration_;
  serial::EmulatedLine line_;
  DriveFirmware firmware_;
  std::optional<Time> report_due_;
  bool tripped_ = false;
  std::uint64_t watchdog_trips_ = 0;

  PlayedContactor played_;
  std::optional<SoundFile> sound_;
  std::string sound_trouble_;
  std::optional<Time> sound_start_;  // of sample 0
  long long sample_ = 0;             // the next
  Time flush_due_{0};
};

}  // namespace haptex::tactile
