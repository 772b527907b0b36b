// How far each contactor moves for how much drive, and how far it may.
#pragma once

#include <string>

#include "haptex/base/finger.h"
#include "haptex/tactile/contactor_array.h"
#include "haptex/tactile/drive/drive_protocol.h"

namespace haptex::tactile {

/// Of one contactor.
struct ContactorCalibration {
  PerChannel<double> full_displacement{};  ///< m, amplitude at full drive in each channel, > 0
  double largest_displacement = 0.0;       ///< m, of both channels together; 0: not to be driven
};

using ArrayCalibration = PerContactor<ContactorCalibration>;

/// Of both fingers.
using Calibration = base::PerFinger<ArrayCalibration>;

/// Reads a calibration file (docs/tactile_protocol.md): for each finger full_displacement_40,
/// full_displacement_320 and largest_displacement (um), each one number for all contactors or 24.
/// @throws std::invalid_argument naming file, key, value and what is allowed; std::runtime_error
///   naming the path if it cannot be read
Calibration loadCalibration(const std::string& path);

/// The drive that moves the contactors by these amplitudes (m, finite, >= 0). Where the two
/// channels together would go beyond what the contactor may or full drive allows, both are less by
/// the same factor. Allocates nothing.
ArrayDrive driveFor(const ArrayAmplitudes& amplitudes, const ArrayCalibration& calibration);

/// Amplitudes (m) of contactors that are driven so: the inverse of driveFor() within the limits.
ArrayAmplitudes amplitudesOf(const ArrayDrive& drive, const ArrayCalibration& calibration);

}  // namespace haptex::tactile
