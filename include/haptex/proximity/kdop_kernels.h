// Inner loops of KdopHierarchy, compiled for several instruction sets.
//
// A volume is kept as its support heights, the largest n . x over its points x for every normal n:
// those of the axes, then those of the opposite normals, each padded with zeros to whole groups of
// kGroup. Then uniting two volumes is one maximum, and telling two volumes apart one comparison.
#pragma once

#include <cstdint>

#include "haptex/proximity/kdop.h"

namespace haptex::proximity {

enum class InstructionSet {
  kBaseline,  ///< what every processor of the platform has
  kAvx2,      ///< x86-64 with AVX2 and FMA
};

/// The best that this processor has.
InstructionSet bestInstructionSet();

namespace kernels {

constexpr int kGroup = 4;  ///< axes

/// A complete binary tree of volumes in breadth-first order: those below volume i are 2 i + 1 and
/// 2 i + 2.
struct VolumeTree {
  const float* heights;  ///< 2 * groups * kGroup per volume
  int first_leaf;        ///< index of the first volume of the last level
};

/// What refit() reads and writes. All particles are relative to one origin.
struct RefitData {
  const float* axes;          ///< x of all axes, then y, then z, each padded
  const float* particles;     ///< x, y, z, unused for each
  const int* leaf_begin;      ///< first entry of each leaf in leaf_particles, and the end
  const int* leaf_particles;  ///< each particle of a leaf once
  float* heights;             ///< of the tree
  int first_leaf;
};

/// Calls visit(context, leaf) for a leaf, counted from 0.
struct Visitor {
  void (*visit)(void* context, int leaf);
  void* context;
};

/// Bodies that are looked for. A volume is near a body if none of its heights is below the body's
/// least.
struct Bodies {
  const float* least;  ///< 2 * groups * kGroup per body, minus infinity for padding
  int count;
};

/// A search that narrows: a volume is near if no height is below the body's least by more than
/// `reach` lengths of its normal.
struct NarrowingSearch {
  Bodies bodies;
  const float* inverse_lengths;  ///< 1/|n|, 2 * groups * kGroup, anything > 0 for padding
  const float* reach;            ///< m, may be lowered by the visitor
};

/// Two volumes of one tree.
struct VolumePair {
  int first, second;
};

struct Kernels {
  void (*refit)(const RefitData& data);
  /// Visits all leaves near a body. @returns how many volumes were tested
  int (*visit)(const VolumeTree& tree, const Bodies& bodies, const Visitor& visitor);
  /// Visits near leaves, the nearer half of each volume first.
  int (*visitNearest)(const VolumeTree& tree, const NarrowingSearch& search,
                      const Visitor& visitor);
  /// Which of at most 32 pairs of volumes are near each other, the first in the lowest bit: no
  /// height of the one and height of the other along the opposite normal have a sum below the
  /// limit.
  /// @param limits m |n|, 2 * groups * kGroup, minus infinity for padding
  std::uint32_t (*nearPairs)(const VolumeTree& tree, const VolumePair* pairs, int count,
                             const float* limits);
};

/// @param groups 1 to 4
/// @throws std::invalid_argument for another number of groups, or if this processor lacks the
///   instruction set
const Kernels& choose(int groups, InstructionSet instruction_set);

/// Groups of axes of a kind.
int groupsOf(KdopKind kind);

}  // namespace kernels
}  // namespace haptex::proximity
