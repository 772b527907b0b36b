#include "haptex/large/sheet.h"

#include <algorithm>
#include <cmath>

#include "haptex/base/quoted.h"
#include "haptex/base/require.h"
#include "haptex/material/fabric_file.h"
#include "haptex/scene/scene.h"

namespace haptex::large {
namespace {

using mesh::Side;
using mesh::Triangulation;

/// Rows on either side of those that are whole: quadratic bending couples particles that are so far
/// apart, or needs as many to know how its hinges bend (test/large/test_sheet.cpp).
constexpr int kMargin = 3;

/// Why a scene is no such sheet; empty if it is.
std::string excessOf(const scene::Scene& scene) {
  const cloth::ModelledEffects& effects = scene.effects;
  if (!scene.any_cells || !scene.frames.empty()) {
    return "its cloth is no sheet, has regions, starts from a saved state or is attached by more "
           "than its sides";
  }
  if (effects.contacts || effects.self_collision) return "its cloth collides";
  if (!effects.fasteners.empty()) return "its cloth has fasteners";
  if (effects.stuffing) return "its cloth is stuffed";
  return "";
}

int cellsOf(double length, double edge) {
  const double cells = std::ceil(length / edge - 1e-9);
  return static_cast<int>(std::clamp<double>(cells, 1.0, kMostParticles));
}

Triangulation triangulationOf(const mesh::ClothMesh& mesh, int cells_u, int cells_v) {
  const auto one_way = mesh::makeRectangle(1.0, 1.0, cells_u, cells_v, Triangulation::kOneWay);
  return mesh.triangles == one_way.triangles ? Triangulation::kOneWay : Triangulation::kAlternating;
}

/// Particle row of the v coordinate of the sheet.
double heightOf(const Sheet& sheet, int row) { return sheet.height * row / sheet.cells_v; }

mesh::ClothMesh meshOf(const Sheet& sheet, const Rows& rows) {
  mesh::ClothMesh mesh = mesh::makeRectangle(sheet.width, sheet.height, sheet.cells_u,
                                             rows.count() - 1, sheet.triangulation);
  for (std::size_t i = 0; i < mesh.rest_coordinates.size(); ++i) {
    Eigen::Vector2d& rest = mesh.rest_coordinates[i];
    rest.y() = heightOf(sheet, rows.begin + static_cast<int>(i) / sheet.rowSize());
    mesh.initial_positions[i] = sheet.corner + sheet.axes * rest;
  }
  return mesh;
}

/// Of the sheet, not of the rows.
bool isOnSide(const Sheet& sheet, int row, int column, Side side) {
  switch (side) {
    case Side::kBottom:
      return row == 0;
    case Side::kTop:
      return row == sheet.cells_v;
    case Side::kLeft:
      return column == 0;
    default:
      return column == sheet.cells_u;
  }
}

}  // namespace

Sheet loadSheet(const std::string& path, double edge) {
  const scene::Scene scene = scene::loadScene(path);
  const std::string excess = excessOf(scene);
  if (!excess.empty()) {
    base::refuse(path, ": ", excess,
                 "; allowed is a sheet that is held by its sides and moves in the air");
  }
  if (!std::isfinite(edge) || edge <= 0.0) {
    base::refuse("the edge is ", edge, " m: allowed are finite lengths greater than 0");
  }
  Sheet sheet;
  const mesh::ClothMesh& mesh = scene.mesh;
  const Eigen::Vector2d size = mesh.rest_coordinates.back();
  sheet.width = size.x();
  sheet.height = size.y();
  sheet.cells_u = cellsOf(sheet.width, edge);
  sheet.cells_v = cellsOf(sheet.height, edge);
  if (sheet.particleCount() > kMostParticles) {
    base::refuse("with edges of ", edge, " m there would be ", sheet.particleCount(),
                 " particles: allowed are ", kMostParticles);
  }
  const auto row = static_cast<std::size_t>(
      std::count_if(mesh.rest_coordinates.begin(), mesh.rest_coordinates.end(),
                    [](const Eigen::Vector2d& rest) { return rest.y() == 0.0; }));
  const auto rows = mesh.rest_coordinates.size() / row;
  sheet.triangulation =
      triangulationOf(mesh, static_cast<int>(row) - 1, static_cast<int>(rows) - 1);
  sheet.corner = mesh.initial_positions.front();
  sheet.axes.col(0) = (mesh.initial_positions[row - 1] - sheet.corner) / sheet.width;
  sheet.axes.col(1) =
      (mesh.initial_positions[mesh.initial_positions.size() - row] - sheet.corner) / sheet.height;
  for (const Side side : {Side::kBottom, Side::kTop, Side::kLeft, Side::kRight}) {
    const std::vector<int> particles = sideParticles(mesh, side);
    const bool all = std::all_of(particles.begin(), particles.end(), [&](int particle) {
      return std::find(scene.attached_particles.begin(), scene.attached_particles.end(),
                       particle) != scene.attached_particles.end();
    });
    if (all) sheet.held.push_back(side);
  }
  sheet.fabric = material::loadFabric(scene.fabric_path);
  sheet.effects = scene.effects;
  sheet.effects.point_loads = false;
  sheet.time_step = scene.time_step;
  return sheet;
}

Rows ownRows(const Sheet& sheet, int part, int parts) {
  const auto first = [&](std::int64_t index) {
    return static_cast<int>(index * sheet.rowCount() / parts);
  };
  return {first(part), first(part + 1)};
}

Rows wholeRows(const Sheet& sheet, int part, int parts) {
  const Rows own = ownRows(sheet, part, parts);
  return {std::max(0, own.begin - kOverlap), std::min(sheet.rowCount(), own.end + kOverlap)};
}

/// The first row is an even one, so that diagonals alternate as in the whole sheet.
Rows knownRows(const Sheet& sheet, int part, int parts) {
  const Rows whole = wholeRows(sheet, part, parts);
  return {std::max(0, whole.begin - kMargin) / 2 * 2,
          std::min(sheet.rowCount(), whole.end + kMargin)};
}

PartPlace placeOf(const Sheet& sheet, int part, int parts) {
  const Rows own = ownRows(sheet, part, parts), whole = wholeRows(sheet, part, parts);
  const int first = knownRows(sheet, part, parts).begin, row = sheet.rowSize();
  return {sheet.particleCount(),   std::int64_t{first} * row,   (own.begin - first) * row,
          (own.end - first) * row, (whole.begin - first) * row, (whole.end - first) * row};
}

cloth::Cloth clothOf(const Sheet& sheet, const Rows& rows) {
  cloth::Cloth cloth(meshOf(sheet, rows), sheet.fabric, sheet.effects);
  for (int i = 0; i < static_cast<int>(cloth.particleCount()); ++i) {
    const int row = rows.begin + i / sheet.rowSize(), column = i % sheet.rowSize();
    const bool held = std::any_of(sheet.held.begin(), sheet.held.end(),
                                  [&](Side side) { return isOnSide(sheet, row, column, side); });
    if (!held) continue;
    cloth::AttachmentPath place;
    place.start = cloth.mesh().initial_positions[i];
    cloth.attach(i, place);
  }
  return cloth;
}

}  // namespace haptex::large
