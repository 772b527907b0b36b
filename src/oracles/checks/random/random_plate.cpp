// Sheets that are bent and twisted: the energy of the plate.
#include <cmath>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/oracles/checks/random_checks.h"

namespace haptex::oracles {
namespace {

using Eigen::Vector3d;

/// A sheet of the rectangle in the plane z = 0, deflected by (kuu u^2 + kvv v^2)/2 + kuv u v.
struct Plate {
  double width, height;  // m
  int cells;             // along the width; across as nearly square as they can be
  double grain;          // rad
  double weft, warp;     // N.m
  double kuu, kvv, kuv;  // 1/m, along the threads
  mesh::Triangulation mesh;
  cloth::BendingModel model;
};

/// Only bending resists: the energy is quadratic, however far the plate is deflected.
double energyOf(const Plate& plate, int refinement) {
  const int cells_u = plate.cells * refinement;
  const int cells_v =
      refinement * std::max(4, static_cast<int>(plate.cells * plate.height / plate.width));
  mesh::ClothMesh mesh =
      mesh::makeRectangle(plate.width, plate.height, cells_u, cells_v, plate.mesh);
  mesh.panels = {{0, plate.grain}};
  material::Fabric fabric;  // limp but for its bending
  fabric.name = "plate";
  fabric.areal_density = 0.1;
  fabric.bending = {plate.weft, plate.warp};
  cloth::ModelledEffects effects;
  effects.bending = true;
  effects.bending_settings.model = plate.model;
  const cloth::Cloth cloth(mesh, fabric, effects);
  cloth::ClothState state = cloth.initialState();
  const Eigen::Rotation2Dd into_fabric(-plate.grain);
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    const Eigen::Vector2d& rest = mesh.rest_coordinates[i];
    const Eigen::Vector2d thread = into_fabric * rest;
    const double u = thread.x(), v = thread.y();
    const double deflection = 0.5 * (plate.kuu * u * u + plate.kvv * v * v) + plate.kuv * u * v;
    state.positions[i] = Vector3d(rest.x(), rest.y(), deflection);
  }
  return cloth.potentialEnergy(state);
}

/// The rim is without a half of a cell's curvature across it: a part of the energy in the first
/// power of the cell's size, at corners in the second. Three meshes tell both.
double extrapolatedEnergy(const Plate& plate) {
  const double coarse = energyOf(plate, 1), middle = energyOf(plate, 2), fine = energyOf(plate, 4);
  const double first = 2.0 * middle - coarse, second = 2.0 * fine - middle;
  return (4.0 * second - first) / 3.0;
}

Plate drawPlate(Random& random) {
  Plate plate;
  plate.width = random.uniform(0.05, 0.5);
  plate.height = plate.width * random.uniform(0.5, 2.0);
  plate.cells = 8 + random.below(5);
  plate.weft = random.logarithmic(1e-7, 1e-3);
  plate.warp = plate.weft * random.logarithmic(0.1, 10.0);
  plate.mesh =
      random.chance(0.5) ? mesh::Triangulation::kOneWay : mesh::Triangulation::kAlternating;
  plate.model = random.chance(0.5) ? cloth::BendingModel::kLinear : cloth::BendingModel::kQuadratic;
  return plate;
}

void validate(const Plate& plate, const CaseName& drawn, const Sink& sink) {
  const double exact =
      plate.width * plate.height *
      (0.5 * (plate.weft * plate.kuu * plate.kuu + plate.warp * plate.kvv * plate.kvv) +
       std::sqrt(plate.weft * plate.warp) * plate.kuv * plate.kuv);
  CaseName text = drawn;
  text.with(plate.model == cloth::BendingModel::kLinear ? "linear" : "quadratic");
  text.with(plate.mesh == mesh::Triangulation::kOneWay ? "one_way" : "alternating");
  text.with("grain", plate.grain).with("warp_over_weft", plate.warp / plate.weft);
  text.with("cells", plate.cells);
  sink(base::relativeTo(exact, text.text(), exact, extrapolatedEnergy(plate), 1e-10));
}

}  // namespace

void randomPlate(const std::string&, Random& random, const Sink& sink) {
  // A cylinder of the curvature k whose axis is oblique to the threads. With the angle t of the
  // curvature from the weft: area k^2/2 (sqrt(Bu) cos^2 t + sqrt(Bv) sin^2 t)^2.
  Plate cylinder = drawPlate(random);
  cylinder.grain = 0.0;
  const double curvature = random.logarithmic(0.1, 100.0), angle = random.uniform(0.0, M_PI);
  cylinder.kuu = curvature * std::pow(std::cos(angle), 2);
  cylinder.kvv = curvature * std::pow(std::sin(angle), 2);
  cylinder.kuv = curvature * std::cos(angle) * std::sin(angle);
  CaseName oblique("cloth", "oblique_cylinder");
  validate(cylinder, oblique.with("curvature", curvature).with("angle", angle), sink);
  // Twist, of threads along the edges, which is all in the mixed term.
  Plate twisted = drawPlate(random);
  twisted.grain = twisted.kuu = twisted.kvv = 0.0;
  twisted.kuv = random.logarithmic(0.1, 100.0);
  CaseName twist("cloth", "twist");
  validate(twisted, twist.with("twist", twisted.kuv), sink);
}

}  // namespace haptex::oracles
