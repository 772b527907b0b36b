// Cloth that intersects itself at the start, at random.
#pragma once

#include <cstddef>
#include <string>

#include "haptex/oracles/scenes/self_colliding_cloth.h"

namespace haptex::oracles {

/// One of four kinds, in turn, with cells of 5 to 10 mm:
/// - shoved: two sheets, tilted against each other by 2 to 10 degrees, that have been shoved some
///   millimetres through each other,
/// - flap: a sheet that is folded over obliquely, its flap pushed through it,
/// - bump: two parallel sheets, of which the upper one has a smooth bump through the lower one,
/// - waves: two parallel sheets, of which the upper one is wavy, and goes through the lower one at
///   several places.
/// Without gravity, or with gravity and attachments: along the rim of the lower sheet, along one
/// side of the flap's.
struct TangledStart {
  SelfCollidingCloth::Set set;  ///< named by its kind
  std::string fabric;           ///< name of its file: linear or wool
};

/// @param index of the start, >= 0: the same start for the same number
TangledStart tangledStart(int index);

/// What became of one.
struct Untangled {
  std::size_t left;      ///< pairs of triangles that intersect at the end
  int misreported = 0;   ///< steps whose report tells another number than the exact test
  double energy_growth;  ///< J, most of any state beyond the start's and what was added since by
                         ///< untangling (TangleReport::energy)
  double energy_range;   ///< J, between the highest and the lowest state
};

/// Steps of 12.5 ms with five Newton iterations.
Untangled untangle(const TangledStart& start, const material::Fabric& fabric, int steps);

/// What became of the first ones.
struct UntangledStarts {
  double free_share = 0.0;     ///< of the starts: without an intersection at the end
  std::size_t left = 0;        ///< Untangled::left of all
  int misreported = 0;         ///< likewise
  double energy_growth = 0.0;  ///< largest of a start, over its energy_range
};

/// untangle() the starts from 0 on.
/// @param count > 0
/// @throws material::loadFabric() of a fabric file
UntangledStarts untangleStarts(int count, int steps, const std::string& config_directory);

}  // namespace haptex::oracles
