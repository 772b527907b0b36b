#include "haptex/studies/extreme_state.h"

#include <algorithm>

namespace haptex::studies {
namespace {

using Eigen::Vector3d;

/// Every second time nothing, else a small part of a cell at random: what lies exactly on a point,
/// a line or in a plane is a case of its own.
double drawJitter(const ExtremeCase& extreme, RepeatableRandom& random) {
  return random.chance(0.5) ? 0.0 : extreme.cell * random.logarithmic(1e-9, 1e-2);
}

template <typename Place>
void moveFree(const cloth::Cloth& cloth, cloth::ClothState& state, Place&& place) {
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    if (!cloth.attachments()[i]) state.positions[i] = place(state.positions[i]);
  }
}

void scramble(const ExtremeCase& extreme, const cloth::Cloth& cloth, RepeatableRandom& random,
              cloth::ClothState& state) {
  const double most = extreme.cell * extreme.magnitude;
  moveFree(cloth, state, [&](const Vector3d& place) -> Vector3d {
    return place + random.uniform(0.0, most) * random.direction();
  });
}

void collapse(const ExtremeCase& extreme, const cloth::Cloth& cloth, RepeatableRandom& random,
              cloth::ClothState& state) {
  const double jitter = drawJitter(extreme, random);
  const Vector3d along = random.chance(0.5) ? Vector3d::Zero() : random.direction();
  const Vector3d middle = state.positions[random.below(static_cast<int>(cloth.particleCount()))];
  moveFree(cloth, state, [&](const Vector3d& place) -> Vector3d {
    return middle + along.dot(place - middle) * along + jitter * random.direction();
  });
}

void mirror(const ExtremeCase& extreme, const cloth::Cloth& cloth, RepeatableRandom& random,
            cloth::ClothState& state) {
  const double jitter = drawJitter(extreme, random);
  const int axis = 1 + random.below(2);
  double low = state.positions[0][axis], high = low;
  for (const Vector3d& position : state.positions) {
    low = std::min(low, position[axis]);
    high = std::max(high, position[axis]);
  }
  // About the upper end, so that it stands upside down on its bar, or about the middle.
  const double about = random.chance(0.5) ? high : 0.5 * (low + high);
  moveFree(cloth, state, [&](Vector3d place) -> Vector3d {
    place[axis] = 2.0 * about - place[axis];
    return place + jitter * random.direction();
  });
}

void flatten(const cloth::Cloth& cloth, RepeatableRandom& random, cloth::ClothState& state) {
  for (const std::array<int, 3>& triangle : cloth.mesh().triangles) {
    if (random.chance(0.5)) continue;
    const int first = random.below(3);
    const int moved = triangle[first];
    if (cloth.attachments()[moved]) continue;
    const Vector3d& a = state.positions[triangle[(first + 1) % 3]];
    const Vector3d& b = state.positions[triangle[(first + 2) % 3]];
    const double share = random.chance(0.5) ? 0.0 : random.uniform(-1.0, 2.0);
    state.positions[moved] = a + share * (b - a);
  }
}

void hurl(const ExtremeCase& extreme, const cloth::Cloth& cloth, RepeatableRandom& random,
          cloth::ClothState& state) {
  const int pattern = random.below(3);  // together, each its own way, about an axis
  const Vector3d direction = random.direction();
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    if (cloth.attachments()[i]) continue;
    Vector3d velocity = direction;
    if (pattern == 1) velocity = random.direction();
    if (pattern == 2) velocity = direction.cross(state.positions[i]).normalized();
    state.velocities[i] = extreme.magnitude * velocity;
  }
}

}  // namespace

void disturbState(const ExtremeCase& extreme, const cloth::Cloth& cloth, RepeatableRandom& random,
                  cloth::ClothState& state) {
  switch (extreme.kind) {
    case ExtremeKind::kScrambled:
      return scramble(extreme, cloth, random, state);
    case ExtremeKind::kCollapsed:
      return collapse(extreme, cloth, random, state);
    case ExtremeKind::kMirrored:
      return mirror(extreme, cloth, random, state);
    case ExtremeKind::kSlivers:
      return flatten(cloth, random, state);
    default:  // pushed
      return hurl(extreme, cloth, random, state);
  }
}

}  // namespace haptex::studies
