// Sheets that need not fit into the memory of one machine: how they are described, and the strips
// of them that several processes know.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/forces/modelled_effects.h"
#include "haptex/material/fabric.h"
#include "haptex/mesh/mesh.h"

namespace haptex::large {

/// A rectangular sheet without its particles.
struct Sheet {
  double width = 0.0, height = 0.0;  ///< m, along weft and warp
  int cells_u = 1, cells_v = 1;      ///< along weft and warp
  mesh::Triangulation triangulation = mesh::Triangulation::kAlternating;
  Eigen::Vector3d corner = Eigen::Vector3d::Zero();  ///< m, world: where (0, 0) is at first
  Eigen::Matrix<double, 3, 2> axes =
      Eigen::Matrix<double, 3, 2>::Zero();  ///< along weft and warp, from there
  std::vector<mesh::Side> held;             ///< sides that stay where they are
  material::Fabric fabric;
  cloth::ModelledEffects effects;
  double time_step = 0.0;  ///< s

  int rowSize() const { return cells_u + 1; }  ///< particles in a row along weft
  int rowCount() const { return cells_v + 1; }
  std::int64_t particleCount() const { return std::int64_t{rowSize()} * rowCount(); }
  std::int64_t triangleCount() const { return std::int64_t{2} * cells_u * cells_v; }
};

/// Of a scene file, with as few cells as make no edge along weft or warp longer than `edge`.
/// Fingers that it asks for are left out, and its integrator and solver do not count.
/// @param edge m
/// @throws std::invalid_argument naming the file and what is allowed if the scene has more than a
///   sheet that is held by its sides and moves in the air, or the edge is not finite and > 0 or so
///   small that there would be more than kMostParticles; what scene::loadScene() throws
Sheet loadSheet(const std::string& path, double edge);

/// Their components are numbered by 32 bits.
constexpr std::int64_t kMostParticles = 700'000'000;

/// Successive rows of particles along weft, from that at v = 0.
struct Rows {
  int begin = 0, end = 0;
  int count() const { return end - begin; }
};

/// Those that a process has: the parts differ by one row at most.
/// @param parts from 1 to the number of rows
Rows ownRows(const Sheet& sheet, int part, int parts);

/// Those and some on either side, kOverlap at most, whose part of a system (Strip) is whole, too.
Rows wholeRows(const Sheet& sheet, int part, int parts);
constexpr int kOverlap = 12;

/// Those and the ones around them that make their part of a system whole.
Rows knownRows(const Sheet& sheet, int part, int parts);

/// Where the particles of a part are among all.
struct PartPlace {
  std::int64_t all = 0;     ///< particles of the sheet
  std::int64_t offset = 0;  ///< of the first particle of the known rows among them
  // Of the known ones:
  int own_begin = 0, own_end = 0;
  int whole_begin = 0, whole_end = 0;  ///< those of wholeRows()
};
PartPlace placeOf(const Sheet& sheet, int part, int parts);

/// The cloth of these rows alone. Its particle i is rows.begin * rowSize() + i of the sheet. Forces
/// on rows at a cut, where the sheet goes on, lack what is beyond.
/// @param rows an even first one, at least two
/// @throws what cloth::Cloth throws
cloth::Cloth clothOf(const Sheet& sheet, const Rows& rows);

}  // namespace haptex::large
