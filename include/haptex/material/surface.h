// The surface of a fabric as a fingertip feels it, KES surface values and the relief they scale,
// and how it reflects light.
#pragma once

#include <array>
#include <string>
#include <variant>

namespace haptex::material {

// Samples of 0.1 mm show yarns from two samples on; a piece of a few millimetres holds a repeat of
// yarns up to the largest spacing.
constexpr double kMinYarnSpacing = 2e-4;  ///< m
constexpr double kMaxYarnSpacing = 3e-3;  ///< m
constexpr double kMaxYarnHeight = 3e-3;   ///< m
constexpr double kMinLoopSpacing = 4e-4;  ///< m
constexpr double kMaxLoopSpacing = 6e-3;  ///< m
constexpr double kMaxIrregularity = 0.5;
constexpr double kMaxSampleSpacing = 1e-3;  ///< m
constexpr double kMaxFieldHeight = 1e-2;    ///< m
constexpr double kMaxRoughness = 1e-3;      ///< m

/// How warp and weft yarns interlace. The number of a twill is what a warp yarn passes over and
/// under, of a satin its repeat, of a rib the weft yarns that lie together.
enum class WeaveKind { kPlain, kTwill22, kTwill31, kSatin5, kRib2 };

/// One of the two systems of parallel yarns.
struct Yarns {
  double spacing;  ///< m, from yarn to yarn, kMinYarnSpacing to kMaxYarnSpacing
  /// m, of their crowns above the middle of the fabric, 0 to kMaxYarnHeight
  double height;
};

/// A woven relief. One of the two heights is > 0.
struct Weave {
  WeaveKind kind;
  Yarns weft;
  Yarns warp;
  /// Coefficient of variation of the yarns along their length, 0 to kMaxIrregularity.
  double irregularity;
};

/// The technical face of a plain knit. Courses, the rows that a yarn knits, run along weft; wales,
/// the columns of loops, along warp.
struct Knit {
  double wale;    ///< m, from wale to wale, kMinLoopSpacing to kMaxLoopSpacing
  double course;  ///< m, from course to course, likewise
  /// Coefficient of variation of the yarn along its length, 0 to kMaxIrregularity.
  double irregularity;
};

/// A measured relief in a file.
struct HeightFile {
  std::string path;
  /// m, between neighbouring samples, > 0, at most kMaxSampleSpacing
  double spacing;
  /// m, of the largest value of a sample above the smallest, > 0, at most kMaxFieldHeight
  double height;
  bool periodic;  ///< whether the field continues at its opposite edge
};

struct Surface {
  /// m, KES SMD: mean deviation of the height, > 0, at most kMaxRoughness
  double roughness;
  /// KES MMD: mean deviation of the coefficient of friction, 0 to 1 and at most that coefficient
  double friction_deviation;
  std::variant<Weave, Knit, HeightFile> relief;
};

/// Shares of red, green and blue light (linear, not sRGB), 0 to 1.
using Colour = std::array<double, 3>;

struct Look {
  Colour warp;   ///< of a warp yarn: what of white light it reflects diffusely where gloss is 0
  Colour weft;   ///< likewise; equal to warp in a knit, which has one yarn
  double gloss;  ///< share of the light that goes into a highlight of the light's colour, 0 to 1
  double width;  ///< of the highlight: roughness, above 0 (mirror) to 1 (as broad as can be)
};

}  // namespace haptex::material
