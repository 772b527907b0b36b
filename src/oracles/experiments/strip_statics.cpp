#include "haptex/oracles/experiments/strip_statics.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "haptex/base/require.h"
#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/kes/equilibrium.h"
#include "haptex/material/linear_fabric.h"

namespace haptex::oracles {
namespace {

using cloth::Cloth;
using cloth::ClothState;
using Eigen::Vector3d;
using mesh::ClothMesh;

constexpr double kGravity = 1.0;     // m/s^2
constexpr double kFirstStep = 0.02;  // s, of a strip that falls

// Of strips that lie free.
constexpr double kFreeLength = 0.1;     // m
constexpr double kFreeModulus = 100.0;  // N/m
constexpr double kFreeRigidity = 1e-5;  // N.m
constexpr int kFreeCells = 40;

/// A strip of square cells.
struct Strip {
  ClothMesh mesh;
  kes::Direction along;
  int cells;  // along it
  int rows;   // across it

  double lengthwise(std::size_t particle) const {
    return mesh.rest_coordinates[particle][along == kes::Direction::kWeft ? 0 : 1];
  }
  double crosswise(std::size_t particle) const {
    return mesh.rest_coordinates[particle][along == kes::Direction::kWeft ? 1 : 0];
  }
  /// 0 at one end, `cells` at the other.
  int column(std::size_t particle) const {
    const int index = static_cast<int>(particle);
    return along == kes::Direction::kWeft ? index % (cells + 1) : index / (rows + 1);
  }
};

/// The two columns at its beginning are straight, so that it is known where a clamp ends.
Strip makeStrip(StripMesh mesh, kes::Direction along, int cells, int rows, double cell,
                unsigned seed = 5) {
  const bool weft = along == kes::Direction::kWeft;
  const int cells_u = weft ? cells : rows, cells_v = weft ? rows : cells;
  const double width = cells_u * cell, height = cells_v * cell;
  const mesh::Triangulation triangulation =
      mesh == StripMesh::kOneWay ? mesh::Triangulation::kOneWay : mesh::Triangulation::kAlternating;
  const ClothMesh regular = mesh::makeRectangle(width, height, cells_u, cells_v, triangulation);
  Strip strip{regular, along, cells, rows};
  if (mesh != StripMesh::kIrregular) return strip;
  strip.mesh = kes::irregularRectangle(width, height, cells_u, cells_v, seed);
  for (std::size_t i = 0; i < regular.rest_coordinates.size(); ++i) {
    if (strip.column(i) == 1) strip.mesh.rest_coordinates[i] = regular.rest_coordinates[i];
  }
  return strip;
}

/// Places the particles and attaches those of the columns that are held.
ClothState placed(const Strip& strip, Cloth& cloth,
                  const std::function<Vector3d(double, double)>& place,
                  const std::function<bool(int)>& held) {
  ClothState state = cloth.initialState();
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    state.positions[i] = place(strip.lengthwise(i), strip.crosswise(i));
    cloth::AttachmentPath path;
    path.start = state.positions[i];
    if (held(strip.column(i))) cloth.attach(static_cast<int>(i), path);
  }
  return state;
}

/// Mean place of the particles in a column.
Vector3d meanOf(const Strip& strip, const ClothState& state, int column) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    if (strip.column(i) == column) sum += state.positions[i] / (strip.rows + 1);
  }
  return sum;
}

/// A strip of the length kFreeLength that nothing holds.
Strip makeFreeStrip(StripMesh mesh, kes::Direction along) {
  constexpr int kRows = 4;
  return makeStrip(mesh, along, kFreeCells, kRows, kFreeLength / kFreeCells);
}

/// Of a strip of that length on a circle of the curvature (1/m). The normal, weft x warp, is +z in
/// the middle.
Vector3d placeOnCircle(kes::Direction along, double lengthwise, double crosswise,
                       double curvature) {
  const double way = lengthwise - 0.5 * kFreeLength, angle = curvature * way;
  const double x = angle == 0.0 ? way : std::sin(angle) / curvature;
  const double z = angle == 0.0 ? 0.0 : (1.0 - std::cos(angle)) / curvature;
  return along == kes::Direction::kWeft ? Vector3d(x, crosswise, z) : Vector3d(crosswise, x, z);
}

/// Curvature (1/m) of the circle x^2 + z^2 + p x + q z + r = 0 nearest to the columns, < 0 if its
/// centre lies below.
double nearestCircle(const Strip& strip, const ClothState& state) {
  const bool weft = strip.along == kes::Direction::kWeft;
  Eigen::MatrixXd circle(strip.cells + 1, 3);
  Eigen::VectorXd squares(strip.cells + 1);
  for (int column = 0; column <= strip.cells; ++column) {
    const Vector3d place = meanOf(strip, state, column);
    const double x = weft ? place.x() : place.y();
    circle.row(column) << x, place.z(), 1.0;
    squares[column] = -(x * x + place.z() * place.z());
  }
  const Vector3d found = circle.colPivHouseholderQr().solve(squares);
  const double radius = std::sqrt(0.25 * found.head<2>().squaredNorm() - found[2]);
  const double middle = meanOf(strip, state, strip.cells / 2).z();
  return (-0.5 * found[1] > middle ? 1.0 : -1.0) / radius;
}

/// The Jacobian's part that moves free particles out of the plane x = 0, negated.
Eigen::MatrixXd sidewaysStiffness(const Cloth& cloth, const ClothState& state) {
  std::vector<int> free, row_of(cloth.particleCount(), -1);
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    if (cloth.attachments()[i]) continue;
    row_of[i] = static_cast<int>(free.size());
    free.push_back(static_cast<int>(i));
  }
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(free.size(), free.size());
  for (const cloth::JacobianBlock& block : cloth.jacobian(state, free)) {
    const int row = row_of[block.row], column = row_of[block.column];
    if (column >= 0) stiffness(row, column) = -block.by_position(0, 0);
  }
  return stiffness;
}

/// x with f(x) = 0 between two ends, f rising.
double root(double low, double high, const std::function<double(double)>& f) {
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (low + high);
    (f(middle) < 0.0 ? low : high) = middle;
  }
  return low;
}

}  // namespace

double simulatedDropOverReach(const Cantilever& cantilever) {
  constexpr double kLength = 0.1;  // m
  constexpr int kRows = 6;
  // Two columns are held: the clamp is half way between them (docs/mechanics.md).
  const double cell = kLength / (cantilever.cells - 0.5);
  Strip strip =
      makeStrip(cantilever.mesh, cantilever.along, cantilever.cells, kRows, cell, cantilever.seed);
  strip.mesh.panels = {{0, cantilever.grain}};
  material::Fabric fabric = material::linearFabric(cantilever.modulus);
  fabric.warp.elastic =
      material::StrainStressCurve::linear(cantilever.warp_over_weft * cantilever.modulus);
  const double rigidity = fabric.areal_density * kGravity * std::pow(kLength, 3) / cantilever.gamma;
  fabric.bending = {cantilever.across * rigidity, cantilever.across * rigidity};
  (cantilever.along == kes::Direction::kWeft ? fabric.bending->weft : fabric.bending->warp) =
      rigidity;
  cloth::ModelledEffects effects;
  effects.gravity = {0.0, 0.0, -kGravity};
  effects.bending = true;
  effects.bending_settings.model = cantilever.model;
  effects.elasticity = cantilever.elasticity;
  Cloth cloth(strip.mesh, fabric, effects);
  ClothState state = placed(
      strip, cloth,
      [&](double along, double across) { return Vector3d(across, along - 0.5 * cell, 0.0); },
      [](int column) { return column < 2; });
  kes::Equilibrium(cloth).settle(cloth, state, kFirstStep);
  const Vector3d tip = meanOf(strip, state, strip.cells);
  return -tip.z() / tip.y();
}

double simulatedTwistTorque(const material::Fabric& fabric, cloth::Elasticity elasticity,
                            mesh::Triangulation triangulation, int cells, double angle) {
  constexpr double kLength = 0.2, kWidth = 0.05;  // m
  cloth::ModelledEffects effects;
  effects.elasticity = elasticity;
  effects.bending = true;
  cloth::Cloth cloth(mesh::makeRectangle(kWidth, kLength, cells / 4, cells, triangulation), fabric,
                     effects);
  cloth::ClothState state = cloth.initialState();
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    const Eigen::Vector2d& rest = cloth.mesh().rest_coordinates[i];
    const double turn = angle * rest.y() / kLength, radius = rest.x() - 0.5 * kWidth;
    state.positions[i] = {radius * std::cos(turn), radius * std::sin(turn), rest.y()};
    if (std::min(rest.y(), kLength - rest.y()) > 1e-9) continue;
    cloth::AttachmentPath path;
    path.start = state.positions[i];
    cloth.attach(static_cast<int>(i), path);
  }
  kes::Equilibrium equilibrium(cloth);
  equilibrium.settle(cloth, state, kFirstStep);
  double torque = 0.0;
  for (int particle : sideParticles(cloth.mesh(), mesh::Side::kTop)) {
    torque -= state.positions[particle].cross(equilibrium.forces()[particle]).z();
  }
  return torque;
}

double simulatedLateralBucklingLoad(StripMesh mesh, int cells) {
  constexpr double kLength = 0.3, kModulus = 1e4, kRigidity = 1e-4;  // m, N/m, N.m
  constexpr int kRows = 3;
  const double cell = kLength / (cells - 0.5);
  const Strip strip = makeStrip(mesh, kes::Direction::kWeft, cells, kRows, cell);
  material::Fabric fabric = material::linearFabric(kModulus);
  fabric.bending = {kRigidity, kRigidity};
  const auto stiffness_under = [&](double gravity) {
    cloth::ModelledEffects effects;
    effects.gravity = {0.0, 0.0, -gravity};
    effects.bending = true;
    Cloth cloth(strip.mesh, fabric, effects);
    ClothState state = placed(
        strip, cloth, [](double along, double across) { return Vector3d(0.0, along, across); },
        [](int column) { return column < 2; });
    if (gravity > 0.0) kes::Equilibrium(cloth).settle(cloth, state, 1.0);
    return sidewaysStiffness(cloth, state);
  };
  // The part that the weight adds grows with it, as the strip hardly bends in its own plane: near
  // the exact load it is scaled to the one that takes all stiffness from some displacement.
  const double gravity =
      kLateralBucklingLoad * kRigidity / (fabric.areal_density * std::pow(kLength, 3));
  const Eigen::MatrixXd unloaded = stiffness_under(0.0);
  const Eigen::MatrixXd added = stiffness_under(gravity) - unloaded;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(added, unloaded,
                                                                         Eigen::EigenvaluesOnly);
  return -kLateralBucklingLoad / solver.eigenvalues().minCoeff();
}

double simulatedRestCurvature(StripMesh mesh, kes::Direction along, cloth::BendingModel model,
                              double curvature) {
  const Strip strip = makeFreeStrip(mesh, along);
  material::Fabric fabric = material::linearFabric(kFreeModulus);
  fabric.bending = {kFreeRigidity, kFreeRigidity};
  cloth::ModelledEffects effects;
  effects.bending = true;
  effects.bending_settings.model = model;
  effects.bending_settings.rest_curvature[along == kes::Direction::kWeft ? 0 : 1] = curvature;
  Cloth cloth(strip.mesh, fabric, effects);
  ClothState state = placed(
      strip, cloth,
      [&](double lengthwise, double crosswise) {
        return placeOnCircle(along, lengthwise, crosswise, 0.0);
      },
      [](int) { return false; });
  kes::Equilibrium(cloth).settle(cloth, state, kFirstStep);
  return nearestCircle(strip, state);
}

double simulatedResidualCurvature(StripMesh mesh, kes::Direction along, cloth::BendingModel model,
                                  double held) {
  const Strip strip = makeFreeStrip(mesh, along);
  material::Fabric fabric = material::linearFabric(kFreeModulus);
  fabric.bending = {kFreeRigidity, kFreeRigidity};
  fabric.bending_hysteresis = {2.0 * kFreeRigidity * held, 2.0 * kFreeRigidity * held};
  cloth::ModelledEffects effects;
  effects.bending = effects.bending_hysteresis = true;
  effects.bending_settings.model = model;
  Cloth cloth(strip.mesh, fabric, effects);
  ClothState state = placed(
      strip, cloth,
      [&](double lengthwise, double crosswise) {
        return placeOnCircle(along, lengthwise, crosswise, 3.0 * held);
      },
      [](int) { return false; });
  cloth.remember(state);
  kes::Equilibrium(cloth).settle(cloth, state, kFirstStep);
  return nearestCircle(strip, state);
}

double exactSagOverSpan(double slack) {
  base::require(slack >= 1.001 && slack <= 1000.0, "exactSagOverSpan", "slack", slack,
                ">= 1.001 and <= 1000");
  // z = c cosh(x / c) over the span 1, by q = 1 / (2 c): length sinh(q) / q.
  const double q = root(0.01, 10.0, [&](double q) { return std::sinh(q) / q - slack; });
  return (std::cosh(q) - 1.0) / (2.0 * q);
}

double simulatedSagOverSpan(StripMesh mesh, int cells, double slack) {
  constexpr double kLength = 0.5, kModulus = 1e5;  // m, N/m: stretched by less than 1e-5
  constexpr int kRows = 3;
  const Strip strip = makeStrip(mesh, kes::Direction::kWeft, cells, kRows, kLength / cells);
  cloth::ModelledEffects effects;
  effects.gravity = {0.0, 0.0, -kGravity};
  Cloth cloth(strip.mesh, material::linearFabric(kModulus), effects);
  // From an arc of the same length and span.
  const double span = kLength / slack;
  const double half = root(1e-3, M_PI, [&](double a) { return span / kLength - std::sin(a) / a; });
  const double radius = 0.5 * kLength / half;
  ClothState state = placed(
      strip, cloth,
      [&](double along, double across) {
        const double angle = along / radius - half;
        return Vector3d(across, radius * std::sin(angle),
                        radius * (std::cos(half) - std::cos(angle)));
      },
      [&](int column) { return column == 0 || column == cells; });
  kes::Equilibrium(cloth).settle(cloth, state, kFirstStep);
  double lowest = 0.0;
  for (int column = 0; column <= cells; ++column) {
    lowest = std::min(lowest, meanOf(strip, state, column).z());
  }
  return -lowest / span;
}

}  // namespace haptex::oracles
