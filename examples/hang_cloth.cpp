// Hangs a sample of a measured fabric from two of its corners, waits until it is at rest, and
// prints how far its lower edge hangs below them.
//
// hang_cloth FABRIC_FILE, for example config/fabrics/wool.yaml

#include <algorithm>
#include <cstdio>
#include <exception>

#include "haptex/base/constants.h"
#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/material/fabric_file.h"

int main(int argc, char** argv) try {
  using namespace haptex;
  if (argc != 2) throw std::invalid_argument("usage: hang_cloth FABRIC_FILE");
  constexpr double kSide = 0.2;   // m
  constexpr int kCells = 16;      // along each side
  constexpr double kStep = 0.01;  // s
  constexpr int kSteps = 500;     // until it is at rest

  const material::Fabric fabric = material::loadFabric(argv[1]);
  const mesh::ClothMesh mesh =
      mesh::makeRectangle(kSide, kSide, kCells, kCells, mesh::Triangulation::kAlternating);

  // What of the fabric and its surroundings is modelled; what is not asked for costs nothing.
  cloth::ModelledEffects effects;
  effects.gravity = {0.0, 0.0, -base::kStandardGravity};
  effects.viscosity = true;
  effects.bending = fabric.bending.has_value();
  effects.air.emplace();  // which stops the swinging

  cloth::Cloth cloth(mesh, fabric, effects);
  const std::vector<int> top = mesh::sideParticles(mesh, mesh::Side::kTop);
  for (const int corner : {top.front(), top.back()}) {
    cloth::AttachmentPath path;
    path.start = mesh.initial_positions[corner];
    cloth.attach(corner, path);
  }

  cloth::ClothState state = cloth.initialState();
  cloth::Integrator integrator(cloth, cloth::StepSettings());
  for (int i = 0; i < kSteps; ++i) {
    if (!integrator.step(cloth, state, kStep).accepted) throw std::runtime_error("a step failed");
  }

  double lowest = 0.0;  // m, below the corners, which are at the height 0
  for (const int particle : mesh::sideParticles(mesh, mesh::Side::kBottom)) {
    lowest = std::max(lowest, -state.positions[particle].z());
  }
  std::printf("%s hangs %.1f mm below its corners\n", fabric.name.c_str(), 1e3 * lowest);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "hang_cloth: %s\n", error.what());
  return 1;
}
