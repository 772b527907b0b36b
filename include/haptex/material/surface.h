// The surface of a fabric as a fingertip feels it: KES surface values and the relief they scale.
#pragma once

#include <string>
#include <variant>

namespace haptex::material {

/// How warp and weft yarns interlace. The number of a twill is what a warp yarn passes over and
/// under, of a satin its repeat, of a rib the weft yarns that lie together.
enum class WeaveKind { kPlain, kTwill22, kTwill31, kSatin5, kRib2 };

/// One of the two systems of parallel yarns.
struct Yarns {
  double spacing;  ///< m, from yarn to yarn, > 0
  double height;   ///< m, of their crowns above the middle of the fabric, >= 0
};

/// A woven relief.
struct Weave {
  WeaveKind kind;
  Yarns weft;
  Yarns warp;
  double irregularity;  ///< coefficient of variation of the yarns along their length, 0 to 0.5
};

/// A measured relief in a file.
struct HeightFile {
  std::string path;
  double spacing;  ///< m, between neighbouring samples, > 0
  double height;   ///< m, of the largest value of a sample above the smallest, > 0
  bool periodic;   ///< whether the field continues at its opposite edge
};

struct Surface {
  double roughness;           ///< m, KES SMD: mean deviation of the height, > 0
  double friction_deviation;  ///< KES MMD: mean deviation of the coefficient of friction, >= 0
  std::variant<Weave, HeightFile> relief;
};

}  // namespace haptex::material
