// What a tester has read of a fabric: CSV files of raw curves and of KES and FAST values.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace haptex::material {

enum class TesterTest { kTensile, kShear, kBending, kCompression, kSurface };

/// x and y by test:
///   tensile      engineering strain, force per width (N/m)
///   shear        shear angle (degrees, of either sign), shear force per width (N/m)
///   bending      curvature (1/m, of either sign), moment per width (N)
///   compression  thickness (m, > 0), pressure (Pa, >= 0)
///   surface      way (m), coefficient of friction
struct Reading {
  double x;
  double y;
  std::size_t line;  ///< of the file
};

/// In the order of the file.
struct ReadingLoop {
  std::vector<Reading> loading;    ///< while strain, angle, curvature or pressure grow
  std::vector<Reading> unloading;  ///< while they shrink
};

/// SI units; ratios instead of percents.
struct TesterFile {
  static constexpr double kMostFall = 0.05;  ///< of a loading branch's largest stress

  std::string path;
  std::string source;    ///< of the readings, for people; may be empty
  bool measured = true;  ///< false: representative
  /// By test and direction: "weft", "warp", or "" of what has none.
  std::map<std::pair<TesterTest, std::string>, ReadingLoop> readings;
  /// By name and direction, where "" is of both.
  std::map<std::pair<std::string, std::string>, double> values;

  /// Empty if there is none.
  const ReadingLoop& loop(TesterTest test, const std::string& direction = "") const;
  /// The value of the direction, or else that of both, or else (direction "") the mean of weft and
  /// warp.
  std::optional<double> value(const std::string& name, const std::string& direction = "") const;
};

/// Bytes of a file of readings at most.
constexpr std::size_t kLargestTesterFile = std::size_t{16} << 20;

/// Reads a file of readings; docs/fit_curves.md describes the format.
/// @throws std::runtime_error if the file cannot be read or is larger than that;
/// std::invalid_argument naming file, line,
///   what is wrong and what is allowed: an unknown test, direction, branch, unit or name, a number
///   that is missing, not finite or out of range, a value that is there twice, or a stress that
///   falls on a loading branch by more than kMostFall
TesterFile readTesterFile(const std::string& path);

}  // namespace haptex::material
