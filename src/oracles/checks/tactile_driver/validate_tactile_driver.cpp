// The oracles of the contactors' driver and drive electronics.
#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "haptex/oracles/checks/validation.h"
#include "haptex/oracles/experiments/lines/contactor_drive.h"
#include "haptex/tactile/channel_sines.h"

namespace haptex::oracles {
namespace {

using base::Finger;
using base::kFingers;
using base::Time;
using std::chrono::milliseconds;
using tactile::ArrayAmplitudes;
using tactile::Calibration;
using tactile::k320;
using tactile::k40;
using tactile::kContactors;
using tactile::PerChannel;
using Amplitudes = ContactorDrive::Amplitudes;

constexpr char kRoom[] = "tactile_driver/";
constexpr double kRate = 44100.0;  // Hz, of the samples that are looked at
constexpr Time kReady = milliseconds(250);

/// Every contactor another, up to 24 and 12 um times the scale.
Amplitudes steady(double scale = 1.0) {
  Amplitudes amplitudes;
  for (const Finger finger : kFingers) {
    for (int i = 0; i < kContactors; ++i) {
      amplitudes[finger][i] = {scale * (1e-6 * (i + 1)), scale * (0.5e-6 * (kContactors - i))};
    }
  }
  return amplitudes;
}

/// Every contactor its own, as an array of benders differs.
Calibration unevenCalibration(std::mt19937& generator) {
  std::uniform_real_distribution<double> full(60e-6, 150e-6), largest(20e-6, 100e-6);
  Calibration calibration;
  for (const Finger finger : kFingers) {
    for (tactile::ContactorCalibration& contactor : calibration[finger]) {
      contactor = {{full(generator), full(generator)}, largest(generator)};
    }
  }
  return calibration;
}

/// Of both channels together, m.
double lineStep(const tactile::ContactorCalibration& contactor) {
  return tactile::kDriveStep *
         (contactor.full_displacement[k40] + contactor.full_displacement[k320]);
}

/// Steady amplitudes against a40 sin(2 pi 40 t) + a320 sin(2 pi 320 t), over two turns of 40 Hz.
/// The error is counted in steps of the line, by which each amplitude is rounded down.
void validateWaveform(const Calibration& calibration, const Sink& sink) {
  ContactorDrive drive(calibration);
  const Amplitudes asked = steady();
  drive.setSource([&](Time) { return asked; });
  drive.run(kReady);
  base::Quantity worst{std::string(kRoom) + "waveform_m", 0.0, 0.0, -1.0, 1.0};
  const auto first = static_cast<long long>(base::seconds(drive.now()) * kRate);
  for (const Finger finger : kFingers) {
    const auto& contactors = calibration[finger];
    const ArrayAmplitudes driven =
        tactile::amplitudesOf(drive.firmware().drive(drive.now())[finger], contactors);
    for (int i = 0; i < kContactors; ++i) {
      for (long long sample = first; sample < first + 2205; ++sample) {
        const double time = static_cast<double>(sample) / kRate;
        const double exact = asked[finger][i][k40] * std::sin(2.0 * M_PI * 40.0 * time) +
                             asked[finger][i][k320] * std::sin(2.0 * M_PI * 320.0 * time);
        base::keepWorse(worst,
                        base::relativeTo(lineStep(contactors[i]), worst.name, exact,
                                         displacement(driven[i], sample, kRate), worst.tolerance));
      }
    }
  }
  sink(worst);
}

/// What a contactor's displacement may change by from one sample to the next: its sines by their
/// slope, and its amplitudes as far as full drive in one period of commands takes them.
double boundOfChange(const PerChannel<double>& before, const PerChannel<double>& after,
                     const PerChannel<double>& full, double step) {
  double bound = 0.0;
  for (const tactile::Channel channel : {k40, k320}) {
    const double amplitude = std::max(before[channel], after[channel]);
    bound += step * (2.0 * M_PI * tactile::kChannelFrequencies[channel] * amplitude +
                     full[channel] / base::seconds(tactile::kDrivePeriod));
  }
  return bound;
}

/// Amplitudes that change at random with every message, over a line that loses, damages, doubles
/// and delays one frame in ten: change from sample to sample over what it may be, at most 1.
void validateContinuity(const Calibration& calibration, const Sink& sink) {
  ContactorDrive drive(calibration, 5);
  std::mt19937 generator(6);
  std::uniform_real_distribution<double> amplitude(0.0, 40e-6);
  drive.setSource([&](Time) {
    Amplitudes amplitudes;
    for (const Finger finger : kFingers) {
      for (PerChannel<double>& contactor : amplitudes[finger]) {
        contactor = {amplitude(generator), amplitude(generator)};
      }
    }
    return amplitudes;
  });
  drive.run(kReady);
  for (const serial::LineFault fault : {serial::LineFault::kDrop, serial::LineFault::kFlip,
                                        serial::LineFault::kDuplicate, serial::LineFault::kDelay}) {
    drive.toDevice().set(fault, 0.1, std::chrono::hours(1));
  }
  constexpr double kStepRate = 4000.0;  // Hz, of ContactorDrive::kStep
  long long sample = 0;
  Amplitudes before{};
  double most = 0.0;
  drive.run(milliseconds(5000), [&] {
    const auto shares = drive.firmware().drive(drive.now());
    for (const Finger finger : kFingers) {
      const ArrayAmplitudes after = tactile::amplitudesOf(shares[finger], calibration[finger]);
      for (int i = 0; sample > 0 && i < kContactors; ++i) {
        const double change = displacement(after[i], sample, kStepRate) -
                              displacement(before[finger][i], sample - 1, kStepRate);
        const double bound = boundOfChange(
            before[finger][i], after[i], calibration[finger][i].full_displacement, 1.0 / kStepRate);
        most = base::largerOrNaN(most, std::abs(change) / bound);
      }
      before[finger] = after;
    }
    ++sample;
  });
  sink({std::string(kRoom) + "largest_change_over_its_bound", 1.0, most,
        base::largerOrNaN(0.0, most - 1.0), kRounding});
}

/// Uneven contactors do what is asked for, and no more than each may: in steps of the line.
void validateCalibration(const Sink& sink) {
  std::mt19937 generator(7);
  const Calibration calibration = unevenCalibration(generator);
  base::Quantity worst{std::string(kRoom) + "calibrated_amplitude_m", 0.0, 0.0, -1.0, 1.0};
  double beyond = 0.0;
  for (const double scale : {0.1, 1.0, 10.0}) {
    ContactorDrive drive(calibration);
    const Amplitudes asked = steady(scale);
    drive.setSource([&](Time) { return asked; });
    drive.run(kReady);
    const auto shares = drive.firmware().drive(drive.now());
    for (const Finger finger : kFingers) {
      const ArrayAmplitudes done = tactile::amplitudesOf(shares[finger], calibration[finger]);
      for (int i = 0; i < kContactors; ++i) {
        const auto& contactor = calibration[finger][i];
        const double together = asked[finger][i][k40] + asked[finger][i][k320];
        const double share = asked[finger][i][k40] / contactor.full_displacement[k40] +
                             asked[finger][i][k320] / contactor.full_displacement[k320];
        const double factor =
            std::min({1.0, contactor.largest_displacement / together, 1.0 / share});
        for (const tactile::Channel channel : {k40, k320}) {
          base::keepWorse(worst, base::relativeTo(lineStep(contactor), worst.name,
                                                  factor * asked[finger][i][channel],
                                                  done[i][channel], worst.tolerance));
        }
        beyond = base::largerOrNaN(
            beyond, (done[i][k40] + done[i][k320]) / contactor.largest_displacement - 1.0);
      }
    }
  }
  sink(worst);
  sink({std::string(kRoom) + "beyond_largest_displacement", 0.0, beyond, beyond, kRounding});
}

/// The longest time from a death, at 50 moments of a step, to contactors that all rest.
void validateSilence(const Calibration& calibration, const std::string& name,
                     const std::function<void(ContactorDrive&)>& die, double allowed_ms,
                     const Sink& sink) {
  double longest = 0.0;
  for (int moment = 0; moment < 50; ++moment) {
    ContactorDrive drive(calibration);
    drive.setSource([](Time) { return steady(); });
    drive.run(kReady + moment * 2 * ContactorDrive::kStep);
    if (!drive.moves()) longest = std::nan("");  // then nothing could fall silent
    const Time death = drive.now();
    die(drive);
    Time moved = death;
    drive.run(milliseconds(200), [&] {
      if (drive.moves()) moved = drive.now();
    });
    longest = base::largerOrNaN(longest, base::milliseconds(moved + ContactorDrive::kStep - death));
  }
  sink({std::string(kRoom) + name, 0.0, longest, longest, allowed_ms});
}

void validateDeaths(const Calibration& calibration, const Sink& sink) {
  validateSilence(
      calibration, "ms_to_rest/source_died", [](ContactorDrive& drive) { drive.killSource(); },
      25.0, sink);
  // The message that does not come was due up to 25 ms later.
  validateSilence(
      calibration, "ms_to_rest/source_silent", [](ContactorDrive& drive) { drive.setSource({}); },
      50.0, sink);
  validateSilence(
      calibration, "ms_to_rest/driver_died", [](ContactorDrive& drive) { drive.killDriver(true); },
      25.0, sink);
  validateSilence(
      calibration, "ms_to_rest/driver_stalled",
      [](ContactorDrive& drive) { drive.killDriver(false); }, 25.0, sink);
  validateSilence(
      calibration, "ms_to_rest/cable_pulled", [](ContactorDrive& drive) { drive.unplug(true); },
      25.0, sink);
}

/// A minute over a line on which everything happens, and how long it takes to recover.
void validateFrames(const Calibration& calibration, const Sink& sink) {
  ContactorDrive drive(calibration, 11);
  drive.setSource([](Time now) { return steady(0.5 + 0.5 * std::sin(3.0 * base::seconds(now))); });
  drive.run(kReady);
  const Time end = drive.now() + std::chrono::seconds(60);
  for (const serial::LineFault fault : serial::lineFaults()) {
    if (fault == serial::LineFault::kStall) continue;
    drive.toDevice().set(fault, 0.05, end);
    drive.toDriver().set(fault, 0.05, end);
  }
  drive.run(std::chrono::seconds(60));
  // Where nothing was damaged nothing is shown.
  const bool damaged = drive.firmware().received().corrupt_frames > 1000;
  const double wrong = damaged ? drive.wronglyObeyed() : std::nan("");
  sink({std::string(kRoom) + "wrong_commands_obeyed", 0.0, wrong, wrong, 0.0});
  drive.run(milliseconds(250));
  const double connected = drive.driver().status().link == serial::LinkStatus::kConnected;
  sink({std::string(kRoom) + "connected_afterwards", 1.0, connected, 1.0 - connected, 0.0});
}

}  // namespace

void validateTactileDriver(const std::string& config_directory, const Sink& sink) {
  const Calibration calibration =
      tactile::loadCalibration(config_directory + "/tactile/representative.yaml");
  validateWaveform(calibration, sink);
  validateContinuity(calibration, sink);
  validateCalibration(sink);
  validateDeaths(calibration, sink);
  validateFrames(calibration, sink);
}

}  // namespace haptex::oracles
