#include "haptex/proximity/kdop_kernels.h"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace haptex::proximity {
namespace kernels {
namespace {

// One register of floats: four lanes with the baseline, eight with AVX2. The results are the same:
// the components of the normals are -1, 0 and 1, so that products are exact and fused
// multiplications round like separate ones.
template <int kLanes>
struct Register;
template <>
struct Register<4> {
  typedef float Floats __attribute__((vector_size(16)));
};
template <>
struct Register<8> {
  typedef float Floats __attribute__((vector_size(32)));
};
template <int kLanes>
using Floats = typename Register<kLanes>::Floats;

constexpr int kDeepest = 32;  // levels below the root, more than an int can number

// By reference: a function that returned a wide register would have another ABI without AVX.
template <typename Lanes>
[[gnu::always_inline]] inline void load(const float* from, Lanes& to) {
  std::memcpy(&to, from, sizeof(Lanes));
}

template <typename Lanes>
[[gnu::always_inline]] inline void store(const Lanes& from, float* to) {
  std::memcpy(to, &from, sizeof(Lanes));
}

/// Heights of one leaf along all axes and their opposites.
template <int kGroups, int kLanes>
[[gnu::always_inline]] inline void fitLeaf(const RefitData& data, int leaf, float* heights) {
  constexpr int kAxes = kGroups * kGroup;
  constexpr int kRegisters = kAxes / kLanes;
  Floats<kLanes> axes[kRegisters][3], most[kRegisters], least[kRegisters];
  for (int r = 0; r < kRegisters; ++r) {
    for (int k = 0; k < 3; ++k) load(data.axes + k * kAxes + r * kLanes, axes[r][k]);
    most[r] = Floats<kLanes>{} - std::numeric_limits<float>::infinity();
    least[r] = Floats<kLanes>{} + std::numeric_limits<float>::infinity();
  }
  for (int i = data.leaf_begin[leaf]; i < data.leaf_begin[leaf + 1]; ++i) {
    const float* particle = data.particles + 4 * std::ptrdiff_t{data.leaf_particles[i]};
    for (int r = 0; r < kRegisters; ++r) {
      const Floats<kLanes> height =
          axes[r][0] * particle[0] + axes[r][1] * particle[1] + axes[r][2] * particle[2];
      most[r] = height > most[r] ? height : most[r];
      least[r] = height < least[r] ? height : least[r];
    }
  }
  for (int r = 0; r < kRegisters; ++r) {
    const Floats<kLanes> opposite = -least[r];
    store(most[r], heights + r * kLanes);
    store(opposite, heights + kAxes + r * kLanes);
  }
}

template <int kGroups, int kLanes>
[[gnu::always_inline]] inline void refit(const RefitData& data) {
  constexpr std::ptrdiff_t kHeights = 2 * kGroups * kGroup;
  const int leaves = data.first_leaf + 1;
  for (int leaf = 0; leaf < leaves; ++leaf) {
    const std::ptrdiff_t volume = data.first_leaf + leaf;
    fitLeaf<kGroups, kLanes>(data, leaf, data.heights + volume * kHeights);
  }
  for (std::ptrdiff_t volume = data.first_leaf - 1; volume >= 0; --volume) {
    const float* halves = data.heights + (2 * volume + 1) * kHeights;
    for (int h = 0; h < kHeights; h += kLanes) {
      Floats<kLanes> half, other;
      load(halves + h, half);
      load(halves + kHeights + h, other);
      const Floats<kLanes> both = half > other ? half : other;
      store(both, data.heights + volume * kHeights + h);
    }
  }
}

template <int kGroups, int kLanes>
[[gnu::always_inline]] inline bool isNear(const float* volume, const float* least) {
  constexpr int kHeights = 2 * kGroups * kGroup;
  decltype(Floats<kLanes>{} < Floats<kLanes>{}) below{};
  for (int h = 0; h < kHeights; h += kLanes) {
    Floats<kLanes> height, wanted;
    load(volume + h, height);
    load(least + h, wanted);
    below |= height < wanted;
  }
  std::int64_t bits[kLanes / 2], any = 0;
  std::memcpy(bits, &below, sizeof(bits));
  for (std::int64_t pair : bits) any |= pair;
  return any == 0;
}

template <int kGroups, int kLanes>
[[gnu::always_inline]] inline bool isNearAny(const float* volume, const Bodies& bodies) {
  for (int body = 0; body < bodies.count; ++body) {
    const float* least = bodies.least + std::ptrdiff_t{body} * 2 * kGroups * kGroup;
    if (isNear<kGroups, kLanes>(volume, least)) return true;
  }
  return false;
}

template <int kGroups, int kLanes>
[[gnu::always_inline]] inline int visit(const VolumeTree& tree, const Bodies& bodies,
                                        const Visitor& visitor) {
  constexpr std::ptrdiff_t kHeights = 2 * kGroups * kGroup;
  int stack[kDeepest];
  int waiting = 0, tested = 1;
  if (isNearAny<kGroups, kLanes>(tree.heights, bodies)) stack[waiting++] = 0;
  while (waiting > 0) {
    const int volume = stack[--waiting];
    if (volume >= tree.first_leaf) {
      visitor.visit(visitor.context, volume - tree.first_leaf);
      continue;
    }
    const int half = 2 * volume + 1;
    const float* heights = tree.heights + half * kHeights;
    tested += 2;
    if (isNearAny<kGroups, kLanes>(heights + kHeights, bodies)) stack[waiting++] = half + 1;
    if (isNearAny<kGroups, kLanes>(heights, bodies)) stack[waiting++] = half;
  }
  return tested;
}

/// How far a volume is at least from the nearest body (m); negative if they may overlap.
template <int kGroups, int kLanes>
[[gnu::always_inline]] inline float gap(const float* volume, const NarrowingSearch& search) {
  constexpr int kHeights = 2 * kGroups * kGroup;
  float smallest = std::numeric_limits<float>::infinity();
  for (int body = 0; body < search.bodies.count; ++body) {
    const float* least = search.bodies.least + std::ptrdiff_t{body} * kHeights;
    Floats<kLanes> widest = Floats<kLanes>{} - std::numeric_limits<float>::infinity();
    for (int h = 0; h < kHeights; h += kLanes) {
      Floats<kLanes> height, wanted, scale;
      load(volume + h, height);
      load(least + h, wanted);
      load(search.inverse_lengths + h, scale);
      const Floats<kLanes> along = (wanted - height) * scale;
      widest = along > widest ? along : widest;
    }
    float farthest = widest[0];
    for (int lane = 1; lane < kLanes; ++lane) {
      if (widest[lane] > farthest) farthest = widest[lane];
    }
    if (farthest < smallest) smallest = farthest;
  }
  return smallest;
}

template <int kGroups, int kLanes>
[[gnu::always_inline]] inline int visitNearest(const VolumeTree& tree,
                                               const NarrowingSearch& search,
                                               const Visitor& visitor) {
  constexpr std::ptrdiff_t kHeights = 2 * kGroups * kGroup;
  struct Waiting {
    int volume;
    float gap;
  } stack[kDeepest];
  int waiting = 0, tested = 1;
  stack[waiting++] = {0, gap<kGroups, kLanes>(tree.heights, search)};
  while (waiting > 0) {
    const Waiting next = stack[--waiting];
    if (next.gap > *search.reach) continue;
    if (next.volume >= tree.first_leaf) {
      visitor.visit(visitor.context, next.volume - tree.first_leaf);
      continue;
    }
    const int half = 2 * next.volume + 1;
    const float* heights = tree.heights + half * kHeights;
    Waiting nearer{half, gap<kGroups, kLanes>(heights, search)};
    Waiting farther{half + 1, gap<kGroups, kLanes>(heights + kHeights, search)};
    tested += 2;
    if (farther.gap < nearer.gap) std::swap(nearer, farther);
    stack[waiting++] = farther;
    stack[waiting++] = nearer;
  }
  return tested;
}

template <int kGroups, int kLanes>
[[gnu::always_inline]] inline std::uint32_t nearPairs(const VolumeTree& tree,
                                                      const VolumePair* pairs, int count,
                                                      const float* limits) {
  constexpr int kAxes = kGroups * kGroup;
  std::uint32_t near = 0;
  for (int i = 0; i < count; ++i) {
    const float* first = tree.heights + 2 * std::ptrdiff_t{kAxes} * pairs[i].first;
    const float* second = tree.heights + 2 * std::ptrdiff_t{kAxes} * pairs[i].second;
    decltype(Floats<kLanes>{} < Floats<kLanes>{}) apart{};
    for (int h = 0; h < 2 * kAxes; h += kLanes) {
      Floats<kLanes> height, opposite, limit;
      load(first + h, height);
      load(second + (h < kAxes ? h + kAxes : h - kAxes), opposite);
      load(limits + h, limit);
      apart |= height + opposite < limit;
    }
    std::int64_t bits[kLanes / 2], any = 0;
    std::memcpy(bits, &apart, sizeof(bits));
    for (std::int64_t pair : bits) any |= pair;
    near |= static_cast<std::uint32_t>(any == 0) << i;
  }
  return near;
}

// Two wrappers, because a template cannot be given the attribute.
template <int kGroups, int kLanes>
struct Baseline {
  static void refit(const RefitData& data) { kernels::refit<kGroups, kLanes>(data); }
  static int visit(const VolumeTree& tree, const Bodies& bodies, const Visitor& visitor) {
    return kernels::visit<kGroups, kLanes>(tree, bodies, visitor);
  }
  static int visitNearest(const VolumeTree& tree, const NarrowingSearch& search,
                          const Visitor& visitor) {
    return kernels::visitNearest<kGroups, kLanes>(tree, search, visitor);
  }
  static std::uint32_t nearPairs(const VolumeTree& tree, const VolumePair* pairs, int count,
                                 const float* limits) {
    return kernels::nearPairs<kGroups, kLanes>(tree, pairs, count, limits);
  }
};

#if defined(__x86_64__)
template <int kGroups, int kLanes>
struct Avx2 {
  [[gnu::target("avx2,fma")]] static void refit(const RefitData& data) {
    // Three groups are twelve axes: not a multiple of eight.
    kernels::refit<kGroups, kGroups % 2 == 0 ? kLanes : kGroup>(data);
  }
  [[gnu::target("avx2,fma")]] static int visit(const VolumeTree& tree, const Bodies& bodies,
                                               const Visitor& visitor) {
    return kernels::visit<kGroups, kLanes>(tree, bodies, visitor);
  }
  [[gnu::target("avx2,fma")]] static int visitNearest(const VolumeTree& tree,
                                                      const NarrowingSearch& search,
                                                      const Visitor& visitor) {
    return kernels::visitNearest<kGroups, kLanes>(tree, search, visitor);
  }
  [[gnu::target("avx2,fma")]] static std::uint32_t nearPairs(const VolumeTree& tree,
                                                             const VolumePair* pairs, int count,
                                                             const float* limits) {
    // A register must not reach over the end of the axes.
    return kernels::nearPairs < kGroups,
           kGroups % 2 == 0 ? kLanes : kGroup > (tree, pairs, count, limits);
  }
};
#endif

bool hasAvx2() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
  return false;
#endif
}

template <template <int, int> class Set, int kLanes>
const Kernels* kernelsOf() {
  static const Kernels kernels[] = {{Set<1, kLanes>::refit, Set<1, kLanes>::visit,
                                     Set<1, kLanes>::visitNearest, Set<1, kLanes>::nearPairs},
                                    {Set<2, kLanes>::refit, Set<2, kLanes>::visit,
                                     Set<2, kLanes>::visitNearest, Set<2, kLanes>::nearPairs},
                                    {Set<3, kLanes>::refit, Set<3, kLanes>::visit,
                                     Set<3, kLanes>::visitNearest, Set<3, kLanes>::nearPairs},
                                    {Set<4, kLanes>::refit, Set<4, kLanes>::visit,
                                     Set<4, kLanes>::visitNearest, Set<4, kLanes>::nearPairs}};
  return kernels;
}

}  // namespace

const Kernels& choose(int groups, InstructionSet instruction_set) {
  if (groups < 1 || groups > 4) {
    throw std::invalid_argument("groups of axes " + std::to_string(groups) +
                                ": must be from 1 to 4");
  }
  if (instruction_set == InstructionSet::kBaseline) return kernelsOf<Baseline, 4>()[groups - 1];
#if defined(__x86_64__)
  if (hasAvx2()) return kernelsOf<Avx2, 8>()[groups - 1];
#endif
  throw std::invalid_argument("instruction set AVX2: this processor lacks it");
}

int groupsOf(KdopKind kind) {
  return (static_cast<int>(kdopAxes(kind).size()) + kGroup - 1) / kGroup;
}

}  // namespace kernels

InstructionSet bestInstructionSet() {
  return kernels::hasAvx2() ? InstructionSet::kAvx2 : InstructionSet::kBaseline;
}

}  // namespace haptex::proximity
