// A figure with the measurements that are asked for.
#pragma once

#include <map>
#include <string>

#include "haptex/garment/body/body.h"

namespace haptex::garment {

/// Measurements by name, m.
using Measures = std::map<std::string, double>;

enum class FigureShape { kFemale, kMale };

/// How much a figure may be made larger or smaller as a whole.
constexpr double kLeastScale = 0.8, kLargestScale = 1.2;
/// How near (m) the measurements come to what is asked.
constexpr double kMeasureTolerance = 1e-3;

/// MakeHuman's young average woman or man, changed until its measurements are those asked for, to
/// kMeasureTolerance; what is not asked for follows. The height is reached by making all of it
/// larger or smaller, every other measurement by MakeHuman's target for it, taken in part. As one
/// target changes what others do, they are found in turns, each as the root of a function of one
/// variable, until none is off by more than 1e-6 m.
/// @param directory with the files of MakeHuman
/// @throws std::invalid_argument naming a measurement that is unknown or that the targets do not
///   reach, the value and what is allowed beside the others; and as loadFigure()
Body measuredBody(const std::string& directory, FigureShape shape, const Measures& asked);

}  // namespace haptex::garment
