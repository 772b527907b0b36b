// Meshes, states and cursors for the tests of this room.
#pragma once

#include <Eigen/Core>
#include <random>
#include <vector>

#include "haptex/mesh/mesh.h"
#include "haptex/oracles/scenes/deformed_sheets.h"
#include "haptex/proximity/cursor.h"

namespace haptex::proximity {

inline mesh::ClothMesh sheet(int cells, double size = 0.2) {
  return mesh::makeRectangle(size, size, cells, cells, mesh::Triangulation::kAlternating);
}

inline std::vector<Eigen::Vector3d> restPositions(const mesh::ClothMesh& mesh) {
  return oracles::deformedSheet(mesh, "flat");
}

/// Cursors of every shape near the particles of a state, as large as a few of its triangles.
class RandomCursors {
 public:
  RandomCursors(const std::vector<Eigen::Vector3d>& positions, double size, unsigned seed)
      : positions_(positions), size_(size), generator_(seed) {}

  double uniform() { return std::uniform_real_distribution<double>(0.0, 1.0)(generator_); }

  Cursor next() {
    switch (count_++ % 5) {
      case 0:
        return Cursor::point(place());
      case 1:
        return Cursor::spheres({sphere()});
      case 2:
        return Cursor::spheres({sphere(), sphere(), sphere()});
      case 3: {
        const Eigen::Vector3d begin = place();
        return Cursor::capsule(begin, begin + 3.0 * offset(), size_ * uniform());
      }
      default: {
        const Sphere begin = sphere();
        return Cursor::taperedCapsule(begin,
                                      {begin.centre + 3.0 * offset(), 2.0 * size_ * uniform()});
      }
    }
  }

 private:
  Eigen::Vector3d offset() {
    return size_ *
           Eigen::Vector3d(2.0 * uniform() - 1.0, 2.0 * uniform() - 1.0, 2.0 * uniform() - 1.0);
  }
  Eigen::Vector3d place() {
    const auto particle = static_cast<std::size_t>(uniform() * positions_.size());
    return positions_[particle] + offset();
  }
  Sphere sphere() { return {place(), size_ * uniform()}; }

  const std::vector<Eigen::Vector3d>& positions_;
  double size_;
  std::mt19937 generator_;
  unsigned count_ = 0;
};

}  // namespace haptex::proximity
