// What do the models of stretch and shear deliver of a fabric, and what does a step of each
// cost? The virtual tensile test with free sides (2500 elements) of wool and the linear reference,
// forces in N; and 12.5 ms steps of a sheet of 2048 triangles that falls from the horizontal for
// one simulated second: mean time of the assembly and of the whole step. bench_models CSV also
// writes the shapes and strains of a sheet of wool that hangs from two corners, by springs, by the
// fabric's curves, and by those with its contraction, for scripts/plot_models.
#include <array>
#include <cmath>
#include <fstream>
#include <iostream>
#include <string>
#include <utility>

#include "haptex/base/constants.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/kes/virtual_test.h"
#include "haptex/material/fabric_file.h"
#include "haptex/oracles/checks/cloth_oracles.h"
#include "tab_lines.h"

namespace {

using namespace haptex;
using cloth::Elasticity;

struct Named {
  const char* name;
  Elasticity elasticity;
};
constexpr std::array<Named, 4> kModels = {{{"green_lagrange", Elasticity::kGreenLagrange},
                                           {"bilinear", Elasticity::kBilinear},
                                           {"mass_spring", Elasticity::kMassSpring},
                                           {"corotational", Elasticity::kCorotational}}};

void printTensileTests(const material::Fabric& fabric, const std::vector<double>& weft_strains,
                       const std::vector<double>& warp_strains) {
  for (bool weft : {true, false}) {
    const auto direction = weft ? kes::Direction::kWeft : kes::Direction::kWarp;
    const std::string of = fabric.name + (weft ? "_weft_" : "_warp_");
    for (double strain : weft ? weft_strains : warp_strains) {
      const std::string at = "/" + of + oracles::numbered(strain) + "/2500";
      bench::printLine("models/fabric" + at, kes::exactTensileForce(fabric, direction, strain),
                       "N");
      for (const Named& model : kModels) {
        const auto readings = kes::tensileTest(fabric, direction, {strain}, model.elasticity);
        bench::printLine(std::string("models/") + model.name + at, readings.back().force, "N");
      }
    }
  }
}

void printStep(const material::Fabric& fabric, const Named& model) {
  cloth::ModelledEffects effects;
  effects.elasticity = model.elasticity;
  effects.gravity = {0.0, 0.0, -base::kStandardGravity};
  mesh::ClothMesh mesh = mesh::makeRectangle(0.5, 0.5, 32, 32, mesh::Triangulation::kAlternating);
  for (Eigen::Vector3d& position : mesh.initial_positions) {
    position = {position.z(), position.y(), 0.0};
  }
  cloth::Cloth cloth(std::move(mesh), fabric, effects);
  cloth::ClothState state = cloth.initialState();
  for (int particle : sideParticles(cloth.mesh(), mesh::Side::kTop)) {
    cloth::AttachmentPath place;
    place.start = state.positions[particle];
    cloth.attach(particle, place);
  }
  cloth::Integrator integrator(cloth, {});
  double assembly = 0.0, total = 0.0;
  constexpr int kSteps = 80;
  for (int i = 0; i < kSteps; ++i) {
    const cloth::StepReport report = integrator.step(cloth, state, 0.0125);
    assembly += report.assembly_seconds / kSteps;
    total += report.total_seconds / kSteps;
  }
  const std::string of = std::string(model.name) + "_" + fabric.name + "/2048";
  bench::printLine("models/assembly_" + of, 1e3 * assembly, "ms");
  bench::printLine("models/step_" + of, 1e3 * total, "ms");
}

/// A square of 1 m, hung from two corners that are 0.8 m apart, after it has come to rest. It
/// starts beside its plane, which it would not leave by itself.
void writeHanging(const material::Fabric& fabric, const char* name, Elasticity elasticity,
                  bool contraction, std::ostream& csv) {
  constexpr int kCells = 32, kSteps = 1200;
  cloth::ModelledEffects effects;
  effects.elasticity = elasticity;
  effects.contraction = contraction;
  effects.bending = true;
  effects.viscosity = true;
  effects.gravity = {0.0, 0.0, -base::kStandardGravity};
  mesh::ClothMesh mesh =
      mesh::makeRectangle(1.0, 1.0, kCells, kCells, mesh::Triangulation::kAlternating);
  for (Eigen::Vector3d& place : mesh.initial_positions) {
    place.x() = 0.02 * std::cos(3.0 * (place.y() + place.z()));
  }
  cloth::Cloth cloth(std::move(mesh), fabric, effects);
  cloth::ClothState state = cloth.initialState();
  const int first = kCells * (kCells + 1);
  for (const int corner : {first, first + kCells}) {
    const Eigen::Vector3d inwards(0.0, corner == first ? 0.1 : -0.1, 0.0);
    cloth.attach(corner, {state.positions[corner], inwards, 0.0, 1.0});
  }
  cloth::Integrator integrator(cloth, {});
  for (int i = 0; i < kSteps; ++i) integrator.step(cloth, state, 0.0125);
  int triangle = 0;
  for (const cloth::MembraneElement& element : cloth::restElements(cloth.mesh())) {
    const cloth::MembraneStrain strain = cloth::greenStrain(element, state.positions);
    for (const int corner : element.particles) {
      const Eigen::Vector3d& place = state.positions[corner];
      csv << name << ',' << triangle << ',' << place.x() << ',' << place.y() << ',' << place.z()
          << ',' << strain[0] << ',' << strain[1] << '\n';
    }
    ++triangle;
  }
}

bool writeShapes(const material::Fabric& fabric, const char* path) {
  std::ofstream csv(path);
  csv << "model,triangle,x,y,z,weft_strain,warp_strain\n";
  writeHanging(fabric, "springs", Elasticity::kMassSpring, false, csv);
  writeHanging(fabric, "measured curves", Elasticity::kGreenLagrange, false, csv);
  writeHanging(fabric, "measured curves and contraction", Elasticity::kGreenLagrange, true, csv);
  csv.close();
  return static_cast<bool>(csv);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string fabrics = HAPTEX_CONFIG_DIRECTORY "/fabrics/";
  const material::Fabric linear = material::loadFabric(fabrics + "linear.yaml");
  const material::Fabric wool = material::loadFabric(fabrics + "wool.yaml");
  printTensileTests(linear, {0.1, 0.5}, {0.1, 0.5});
  printTensileTests(wool, {0.01, 0.05, 0.1}, {0.001, 0.006, 0.0135});
  for (const Named& model : kModels) {
    printStep(linear, model);
    printStep(wool, model);
  }
  if (argc > 1 && !writeShapes(wool, argv[1])) {
    std::cerr << "bench_models: cannot write " << argv[1] << '\n';
    return 1;
  }
}
