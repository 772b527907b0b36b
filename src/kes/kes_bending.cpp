// KES-FB2: pure bending between two clamps.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "haptex/base/quoted.h"
#include "haptex/kes/static_sample.h"
#include "haptex/kes/virtual_kes.h"
#include "haptex/kes/virtual_test.h"

namespace haptex::kes {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Rows of cells that bend: the clamps hold two rows of particles each, between which the cloth
// does not, and turn by an angle at each row of particles from one clamp's inner row to the
// other's.
constexpr int kTurns = 25;
constexpr int kCells = kTurns + 1;
constexpr int kCellsAcross = 10;
constexpr double kCell = kKesBendingGauge / kTurns;  // m
constexpr double kWidth = 0.01;                      // m

/// A strip that one clamp bends along a circle. The pulled length of the arc is that of the cloth.
class BendingRig {
 public:
  BendingRig(const material::Fabric& fabric, Direction direction)
      : weft_(direction == Direction::kWeft), sample_(mesh(weft_), fabric, effects(fabric)) {
    for (std::size_t i = 0; i < sample_.mesh().rest_coordinates.size(); ++i) {
      const int row = rowOf(sample_.mesh().rest_coordinates[i]);
      if (row > 1 && row < kCells - 1) continue;
      held_.push_back(static_cast<int>(i));
      if (row > 1) moving_.push_back(static_cast<int>(i));
    }
  }

  /// @return moment per width (N) at a curvature (1/m): the virtual work of the clamp as it turns
  double bend(double curvature) {
    const double angle = curvature * kCell;
    sample_.equilibrate(held_, [&](const Vector2d& rest) { return place(rest, angle); },
                        {1e-6, 1e-6, 1e-6});
    constexpr double kStep = 1e-6;  // rad
    double work = 0.0;              // N.m per rad of the angle from row to row
    for (int particle : moving_) {
      const Vector2d& rest = sample_.mesh().rest_coordinates[particle];
      const Vector3d way =
          (place(rest, angle + kStep) - place(rest, angle - kStep)) / (2.0 * kStep);
      work += sample_.reaction(particle).dot(way);
    }
    return work / kTurns / kWidth;
  }

 private:
  static mesh::ClothMesh mesh(bool weft) {
    const double length = kCell * kCells;
    return weft ? mesh::makeRectangle(length, kWidth, kCells, kCellsAcross,
                                      mesh::Triangulation::kAlternating)
                : mesh::makeRectangle(kWidth, length, kCellsAcross, kCells,
                                      mesh::Triangulation::kAlternating);
  }
  static cloth::ModelledEffects effects(const material::Fabric& fabric) {
    cloth::ModelledEffects effects;
    effects.bending = true;
    effects.bending_hysteresis = fabric.bending_hysteresis.has_value();
    return effects;
  }
  int rowOf(const Vector2d& rest) const {
    return static_cast<int>(std::lround((weft_ ? rest.x() : rest.y()) / kCell));
  }
  /// Along x, bent towards z by the angle at every row from the second to the last but one.
  Vector3d place(const Vector2d& rest, double angle) const {
    Vector3d result(0.0, weft_ ? rest.y() : rest.x(), 0.0);
    for (int row = 0; row < rowOf(rest); ++row) {
      result += kCell * Vector3d(std::cos(row * angle), 0.0, std::sin(row * angle));
    }
    return result;
  }

  bool weft_;
  StaticSample sample_;
  std::vector<int> held_, moving_;
};

void addBending(const material::Fabric& fabric, Direction direction, KesResult& result) {
  const std::string name = nameOf(direction);
  const double rigidity =
      direction == Direction::kWeft ? fabric.bending->weft : fabric.bending->warp;
  double hysteresis = 0.0;
  if (const auto& both = fabric.bending_hysteresis) {
    hysteresis = direction == Direction::kWeft ? both->weft : both->warp;
  }
  BendingRig rig(fabric, direction);
  // There from the largest curvature on one side to that on the other, and back.
  std::vector<double> curvatures, there, back;
  for (int i = -5; i <= 5; ++i) curvatures.push_back(0.2 * kKesLargestCurvature * i);
  for (double curvature : curvatures) there.push_back(rig.bend(curvature));
  for (auto it = curvatures.rbegin(); it != curvatures.rend(); ++it) back.push_back(rig.bend(*it));
  std::reverse(back.begin(), back.end());
  for (std::size_t i = 0; i < curvatures.size(); ++i) {
    double exact = rigidity * curvatures[i];
    // The cycle turns at its ends, where friction resists on both ways in the same direction.
    if (i == 0) exact -= 0.5 * hysteresis;
    if (i + 1 == curvatures.size()) exact += 0.5 * hysteresis;
    result.points.push_back({"bending", name, curvatures[i], 0.5 * (there[i] + back[i]), exact});
  }
  // KES takes the slope from 50 to 150 /m, and the width of the cycle at 100 /m.
  const auto slope = [&](const std::vector<double>& moments) {
    return 0.5 * (moments[8] - moments[6] + moments[4] - moments[2]) /
           (curvatures[8] - curvatures[6]);
  };
  const auto width = [&](int i) { return std::abs(there[i] - back[i]); };
  constexpr double kRigidityUnit = 9.80665e-5, kMomentUnit = 9.80665e-3;
  result.parameters.push_back({"B/" + name, "gf.cm2/cm", rigidity / kRigidityUnit,
                               0.5 * (slope(there) + slope(back)) / kRigidityUnit});
  result.parameters.push_back({"2HB/" + name, "gf.cm/cm", hysteresis / kMomentUnit,
                               0.5 * (width(7) + width(3)) / kMomentUnit});
}

}  // namespace

KesResult kesBending(const material::Fabric& fabric) {
  if (!fabric.bending) {
    throw std::invalid_argument("fabric " + base::quoted(fabric.name) +
                                " has no bending rigidity: add the key bending");
  }
  KesResult result;
  addBending(fabric, Direction::kWeft, result);
  addBending(fabric, Direction::kWarp, result);
  return result;
}

}  // namespace haptex::kes
