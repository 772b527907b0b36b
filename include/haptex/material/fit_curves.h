// The program fit_curves: from a tester's readings to a fabric file.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "haptex/material/tester_fabric.h"

namespace haptex::material {

constexpr int kDefaultPieces = 8;
constexpr int kMostPieces = 100;

extern const char* const kFitCurvesUsage;

struct FitRequest {
  std::string file;             ///< of readings
  std::string name;             ///< of the fabric
  int pieces = kDefaultPieces;  ///< of each curve
};

/// @param arguments without the program's name: CSV [--pieces N] [--name NAME]; without NAME the
///   fabric is called like the file
/// @throws std::invalid_argument naming the argument that is wrong, missing or unknown
FitRequest parseFitRequest(const std::vector<std::string>& arguments);

/// Prints lines "fit test readings pieces rms largest unit rms_percent largest_percent", percents
/// of the largest reading, and "parameter name unit value stated", separated by tabs.
void printReport(const FitReport& report, std::ostream& out);

/// The whole program: the fabric file to `out`, the report to `notes`.
/// @return the exit status: 0, 1 if the readings are refused, 2 if the arguments are
int fitCurves(const std::vector<std::string>& arguments, std::ostream& out, std::ostream& notes);

}  // namespace haptex::material
