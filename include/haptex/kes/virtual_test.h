// Virtual tensile and shear tests of a fabric, as a tester would run them on the simulated cloth.
#pragma once

#include <vector>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/kes/static_sample.h"
#include "haptex/material/fabric.h"
#include "haptex/mesh/mesh.h"

namespace haptex::kes {

/// A rectangle whose interior rest coordinates (and initial positions with them) are moved at
/// random by up to 0.3 of a cell in u and v, so that no two triangles are alike; by less where a
/// triangle would be turned over.
mesh::ClothMesh irregularRectangle(double width, double height, int cells_u, int cells_v,
                                   unsigned seed);

/// One reading of a test.
struct Reading {
  double strain;  ///< tensile: engineering strain; shear: tangent of the shear angle
  double force;   ///< N on the moving jaw, in the direction in which it moves
};

enum class Direction { kWeft, kWarp };
/// In what the programs print.
constexpr const char* nameOf(Direction direction) {
  return direction == Direction::kWeft ? "weft" : "warp";
}

/// Sample of the virtual tests: 200 mm wide, 100 mm between the jaws, 2500 elements on an irregular
/// mesh.
constexpr double kSampleWidth = 0.2;
constexpr double kSampleLength = 0.1;

/// Both jaws hold a full edge, the sides are free.
class TensileRig {
 public:
  /// @param effects the mesh of springs is regular
  TensileRig(const material::Fabric& fabric, Direction direction,
             const cloth::ModelledEffects& effects = {});

  /// Puts a new sample between the jaws, which has no past.
  void renew() { sample_.renew(); }
  /// To an engineering strain > -1, where the sample comes to rest.
  /// @throws std::runtime_error if it does not
  void pull(double strain);
  /// Passes through that place at a rate (1/s) of engineering strain.
  void move(double strain_rate);
  double force() const;  ///< N, on the moving jaw, in the direction of the pull

 private:
  bool weft_;
  StaticSample sample_;
  std::vector<int> jaw_, held_;
};

/// Both jaws hold a full edge, the sides are guided on straight lines.
class ShearRig {
 public:
  /// @param direction in which the moving jaw shears the sample; it pulls on the other threads
  ShearRig(const material::Fabric& fabric, Direction direction,
           const cloth::ModelledEffects& effects = {});

  /// Moves the jaw by `shear` times the length of the sample, at `height` times that length from
  /// the other jaw, where the sample comes to rest.
  /// @param disturbance m, of the particles before it does (StaticSample::equilibrate())
  /// @throws std::runtime_error if it does not
  void shear(double shear, double height,
             const Eigen::Vector3d& disturbance = StaticSample::kDisturbance);
  /// Passes through that place at these rates (1/s).
  void move(double shear_rate, double height_rate);

  /// On the moving jaw (N).
  struct Force {
    double along;   ///< the shear
    double across;  ///< pulling the jaws apart
  };
  Force force() const;

 private:
  bool weft_;
  StaticSample sample_;
  std::vector<int> jaw_, held_;
};

/// Tensile test: both jaws hold a full edge, the sides are free, and every reading is taken in
/// static equilibrium, which is solved for from the disturbed equilibrium before.
/// Exact force of Green-Lagrange elasticity: width l s((l^2 - 1)/2) at stretch l = 1 + strain.
/// @param strains    > -1, in the order of the test
/// @param elasticity as for TensileRig
/// @throws std::runtime_error if the equilibrium is not reached
std::vector<Reading> tensileTest(const material::Fabric& fabric, Direction direction,
                                 const std::vector<double>& strains,
                                 cloth::Elasticity elasticity = cloth::Elasticity::kGreenLagrange);

/// Shear test along weft at constant distance of the jaws, the sides guided on straight lines. The
/// force is that of the jaw without its two corners, which the guides pull too, scaled up by the
/// width that the corners stand for.
/// Exact force: width P12 with P12 = fs(g) + g fv(g^2 / 2) at shear g.
/// @throws std::runtime_error if the equilibrium is not reached
std::vector<Reading> shearTest(const material::Fabric& fabric, const std::vector<double>& shears);

/// The exact forces of the two tests above (N).
/// @param strain engineering, finite and > -1 @throws std::invalid_argument naming another one
double exactTensileForce(const material::Fabric& fabric, Direction direction, double strain);
/// @param shear tangent of the angle, finite @throws std::invalid_argument naming another one
double exactShearForce(const material::Fabric& fabric, double shear);

}  // namespace haptex::kes
