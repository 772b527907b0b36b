// Presses a fingertip into a sheet that is held at its rim, at 1 kHz, and prints the force on it.
// Only the cloth around the fingertip is computed so often: a patch, refined from the sheet.
//
// press_patch FABRIC_FILE, for example config/fabrics/wool.yaml

#include <cstdio>
#include <exception>
#include <numeric>

#include "haptex/contact/haptic_layer.h"
#include "haptex/material/fabric_file.h"

int main(int argc, char** argv) try {
  using namespace haptex;
  if (argc != 2) throw std::invalid_argument("usage: press_patch FABRIC_FILE");
  constexpr double kSide = 0.05, kDepth = 2e-3, kRadius = 8e-3;  // m
  constexpr int kTicks = 200;                                    // of a millisecond

  const material::Fabric fabric = material::loadFabric(argv[1]);
  const mesh::ClothMesh mesh =
      mesh::makeRectangle(kSide, kSide, 8, 8, mesh::Triangulation::kAlternating);
  cloth::ModelledEffects effects;
  effects.viscosity = effects.bending = true;
  contact::HapticLayer layer(mesh, fabric, effects, contact::HapticSettings());

  // The large-scale cloth, which stays where it is: the rim of the patch follows its states.
  const std::vector<Eigen::Vector3d> still(mesh.initial_positions.size(), Eigen::Vector3d::Zero());
  layer.receive(mesh.initial_positions, still, 0.02);
  std::vector<int> whole(mesh.triangles.size());
  std::iota(whole.begin(), whole.end(), 0);
  std::vector<char> attached(mesh.initial_positions.size(), 0);
  for (const mesh::Side side :
       {mesh::Side::kTop, mesh::Side::kBottom, mesh::Side::kLeft, mesh::Side::kRight}) {
    for (const int particle : mesh::sideParticles(mesh, side)) attached[particle] = 1;
  }
  layer.exchange(layer.preparePatch(whole, attached));

  // The sheet is the plane x = 0, its middle half a side below the origin.
  const double touch = kRadius + layer.law().halfThickness();
  contact::Fingertips fingertips;
  contact::Fingertip& index = fingertips[base::Finger::kIndex].emplace();
  index.radius = kRadius;
  for (int tick = 1; tick <= kTicks; ++tick) {
    const double depth = kDepth * tick / kTicks;
    index.position = {touch - depth, 0.0, -0.5 * kSide};
    index.velocity = {-kDepth / (kTicks * layer.settings().time_step), 0.0, 0.0};
    layer.step(fingertips);
    const contact::FingertipContact& felt = layer.contacts()[base::Finger::kIndex];
    if (tick % 50 == 0) std::printf("%.2f mm: %.3f N\n", 1e3 * depth, felt.force.x());
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "press_patch: %s\n", error.what());
  return 1;
}
