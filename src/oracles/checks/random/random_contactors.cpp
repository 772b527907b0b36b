// Contactors of any calibration that are asked for any amplitudes, and die at any moment.
#include <algorithm>
#include <chrono>

#include "haptex/oracles/checks/random_checks.h"
#include "haptex/oracles/experiments/lines/contactor_drive.h"

namespace haptex::oracles {
namespace {

using base::Finger;
using base::kFingers;

/// Full displacements of 20 to 200 um, limits of 5 to 200 um.
tactile::Calibration drawnCalibration(Random& random) {
  tactile::Calibration calibration;
  for (const Finger finger : kFingers) {
    for (tactile::ContactorCalibration& contactor : calibration[finger]) {
      for (double& full : contactor.full_displacement) full = random.logarithmic(2e-5, 2e-4);
      contactor.largest_displacement = random.logarithmic(5e-6, 2e-4);
    }
  }
  return calibration;
}

ContactorDrive::Amplitudes drawnAmplitudes(Random& random) {
  ContactorDrive::Amplitudes amplitudes;
  for (const Finger finger : kFingers) {
    for (tactile::PerChannel<double>& contactor : amplitudes[finger]) {
      for (double& amplitude : contactor) amplitude = random.logarithmic(1e-7, 1e-4);
    }
  }
  return amplitudes;
}

/// What a contactor is to do: what was asked for by the largest factor up to 1 that neither its
/// displacement nor full drive forbids.
double allowedFactor(const tactile::PerChannel<double>& asked,
                     const tactile::ContactorCalibration& contactor) {
  const double together = asked[0] + asked[1];
  const double drive =
      asked[0] / contactor.full_displacement[0] + asked[1] / contactor.full_displacement[1];
  return std::min({1.0, contactor.largest_displacement / together, 1.0 / drive});
}

}  // namespace

/// Amplitudes within a step of the line, and at rest within 25 ms of the death of the source.
void randomContactors(const std::string&, Random& random, const Sink& sink) {
  const CaseName prefix("tactile_driver", "contactors");
  for (int i = 0; i < 5; ++i) {
    const tactile::Calibration calibration = drawnCalibration(random);
    const ContactorDrive::Amplitudes asked = drawnAmplitudes(random);
    const double moment = random.uniform(0.0, 25.0);  // ms, of a step
    ContactorDrive drive(calibration);
    drive.setSource([&](base::Time) { return asked; });
    drive.run(std::chrono::milliseconds(250));
    CaseName text = prefix;
    text.with("moment", moment);
    base::Quantity worst{text.text() + "/amplitude_m", 0.0, 0.0, -1.0, 1.0};
    const auto shares = drive.firmware().drive(drive.now());
    for (const Finger finger : kFingers) {
      const auto done = tactile::amplitudesOf(shares[finger], calibration[finger]);
      for (int j = 0; j < tactile::kContactors; ++j) {
        const double factor = allowedFactor(asked[finger][j], calibration[finger][j]);
        for (const tactile::Channel channel : {tactile::k40, tactile::k320}) {
          // Each is rounded down; where both are full drive together, one takes what is left.
          const double step =
              2.0 * tactile::kDriveStep * calibration[finger][j].full_displacement[channel];
          base::keepWorse(worst,
                          base::relativeTo(step, worst.name, factor * asked[finger][j][channel],
                                           done[j][channel], worst.tolerance));
        }
      }
    }
    sink(worst);
    drive.run(std::chrono::microseconds(static_cast<int>(1e3 * moment)));
    const base::Time death = drive.now();
    base::Time moved = death;
    drive.killSource();
    drive.run(std::chrono::milliseconds(100), [&] {
      if (drive.moves()) moved = drive.now();
    });
    const double rest = base::milliseconds(moved + ContactorDrive::kStep - death);
    sink({text.text() + "/ms_to_rest", 0.0, rest, rest, 25.0});
  }
}

}  // namespace haptex::oracles
