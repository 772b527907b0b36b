#include "haptex/oracles/experiments/hung_square.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "haptex/base/constants.h"
#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/kes/equilibrium.h"

namespace haptex::oracles {
namespace {

using cloth::Cloth;
using cloth::ClothState;
using Eigen::Vector2d;
using Eigen::Vector3d;
using mesh::ClothMesh;

constexpr double kSide = 0.2;       // m
constexpr double kNearer = 0.95;    // of the distance of the points in the sheet
constexpr double kBulge = 0.01;     // m, of the first start
constexpr double kFirstStep = 1.0;  // s

/// Of the three ways.
enum class Cut { kOne, kOther, kAlternating };

ClothMesh squareOf(int cells, Cut cut) {
  const auto triangulation =
      cut == Cut::kOne ? mesh::Triangulation::kOneWay : mesh::Triangulation::kAlternating;
  ClothMesh mesh = mesh::makeRectangle(kSide, kSide, cells, cells, triangulation);
  if (cut != Cut::kOther) return mesh;
  mesh.triangles.clear();
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) {
      const int first = j * (cells + 1) + i, above = first + cells + 1;
      mesh.triangles.push_back({first, first + 1, above});
      mesh.triangles.push_back({first + 1, above + 1, above});
    }
  }
  return mesh;
}

/// A cloth that hangs by two of its particles, and how it lies between them.
class HungSquare {
 public:
  HungSquare(const material::Fabric& fabric, cloth::Elasticity elasticity, int cells, Cut cut)
      : cloth_(squareOf(cells, cut), fabric, effectsOf(elasticity)),
        points_{cells * (cells + 1), cells / 2 * (cells + 1) + cells} {
    for (const int point : points_) {
      cloth::AttachmentPath path;
      path.start = bulged(point, 0.0);
      cloth_.attach(point, path);
    }
  }

  std::vector<Vector3d> start() const {
    std::vector<Vector3d> places;
    for (std::size_t i = 0; i < cloth_.particleCount(); ++i) {
      places.push_back(bulged(static_cast<int>(i), kBulge));
    }
    return places;
  }

  /// Where it comes to rest from these places.
  ClothState settledFrom(const std::vector<Vector3d>& places) {
    ClothState state = cloth_.initialState();
    state.positions = places;
    kes::Equilibrium(cloth_).settle(cloth_, state, kFirstStep);
    return state;
  }

  double energy(const ClothState& state) const { return cloth_.potentialEnergy(state); }

 private:
  static cloth::ModelledEffects effectsOf(cloth::Elasticity elasticity) {
    cloth::ModelledEffects effects;
    effects.elasticity = elasticity;
    effects.bending = true;
    effects.gravity = {0.0, 0.0, -base::kStandardGravity};
    return effects;
  }

  /// The place of a particle with the corner at the origin and the other point along x.
  Vector3d bulged(int particle, double bulge) const {
    const std::vector<Vector2d>& rest = cloth_.mesh().rest_coordinates;
    const Vector2d way = rest[points_[1]] - rest[points_[0]], along = way.normalized();
    const Vector2d from_corner = rest[particle] - rest[points_[0]];
    const double x = from_corner.dot(along), z = from_corner.dot(Vector2d(-along.y(), along.x()));
    return {kNearer * x, bulge * std::sin(M_PI * x / way.norm()) * (1.0 + z / kSide), z};
  }

  Cloth cloth_;
  std::array<int, 2> points_;  // the corner and the middle of the side
};

}  // namespace

CutDifference differenceOfCuts(const material::Fabric& fabric, cloth::Elasticity elasticity,
                               int cells) {
  HungSquare first(fabric, elasticity, cells, Cut::kAlternating);
  const ClothState common = first.settledFrom(first.start());
  std::vector<ClothState> found;
  std::vector<double> energies;
  for (const Cut cut : {Cut::kOne, Cut::kOther, Cut::kAlternating}) {
    HungSquare square(fabric, elasticity, cells, cut);
    found.push_back(square.settledFrom(common.positions));
    energies.push_back(square.energy(found.back()));
  }
  CutDifference difference{0.0, 0.0};
  for (std::size_t i = 0; i < found.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      for (std::size_t k = 0; k < common.positions.size(); ++k) {
        difference.apart =
            std::max(difference.apart, (found[i].positions[k] - found[j].positions[k]).norm());
      }
      difference.energy =
          std::max(difference.energy, std::abs(energies[i] - energies[j]) / std::abs(energies[j]));
    }
  }
  return difference;
}

}  // namespace haptex::oracles
