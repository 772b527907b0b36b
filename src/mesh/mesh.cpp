#include "haptex/mesh/mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>
#include <stdexcept>

namespace haptex::mesh {
namespace {

void requireLength(const char* name, double value) {
  if (!std::isfinite(value) || value <= 0.0) {
    std::ostringstream message;
    message << name << " is " << value << " m; it must be finite and greater than 0";
    throw std::invalid_argument(message.str());
  }
}

void requireCells(const char* name, int value) {
  if (value < 1) {
    std::ostringstream message;
    message << name << " is " << value << "; it must be at least 1";
    throw std::invalid_argument(message.str());
  }
}

void describe(std::ostringstream& text, const char* what, const std::vector<int>& indices) {
  if (indices.empty()) return;
  if (text.tellp() > 0) text << "; ";
  text << what << ":";
  constexpr std::size_t kMaxNamed = 10;
  for (std::size_t i = 0; i < std::min(indices.size(), kMaxNamed); ++i) text << ' ' << indices[i];
  if (indices.size() > kMaxNamed) text << " and " << indices.size() - kMaxNamed << " more";
}

/// Smallest altitude over longest edge of a rest triangle; 0 if a particle is repeated.
double slenderness(const std::array<Eigen::Vector2d, 3>& corners) {
  const Eigen::Vector2d ab = corners[1] - corners[0];
  const Eigen::Vector2d ac = corners[2] - corners[0];
  const double longest = std::max({ab.norm(), ac.norm(), (ac - ab).norm()});
  if (longest == 0.0) return 0.0;
  return std::abs(ab.x() * ac.y() - ab.y() * ac.x()) / (longest * longest);
}

void findPanelDefects(const ClothMesh& mesh, MeshDefects& defects) {
  const std::size_t triangles = mesh.triangles.size();
  const bool fits =
      (mesh.triangle_panels.empty() || mesh.triangle_panels.size() == triangles) &&
      (mesh.corner_coordinates.empty() || mesh.corner_coordinates.size() == triangles) &&
      (mesh.triangle_fabrics.empty() || mesh.triangle_fabrics.size() == triangles);
  defects.panel_mismatch = !fits;
  for (std::size_t p = 0; p < mesh.panels.size(); ++p) {
    const Panel& panel = mesh.panels[p];
    if (panel.fabric >= 0 && std::isfinite(panel.grain)) continue;
    defects.unsound_panels.push_back(static_cast<int>(p));
  }
  for (std::size_t t = 0; t < mesh.triangle_panels.size(); ++t) {
    const int panel = mesh.triangle_panels[t];
    if (panel >= 0 && panel < mesh.panelCount()) continue;
    defects.unknown_panels.push_back(static_cast<int>(t));
  }
  for (std::size_t t = 0; t < mesh.triangle_fabrics.size(); ++t) {
    if (mesh.triangle_fabrics[t] < 0) defects.unsound_fabrics.push_back(static_cast<int>(t));
  }
}

/// The one of a particle's places in a panel that a corner has, which is added if it is new.
std::size_t placeOf(const Eigen::Vector2d& corner, std::vector<Eigen::Vector2d>& places) {
  constexpr double kSame = 1e-9;  // of the coordinates
  for (std::size_t i = 0; i < places.size(); ++i) {
    if ((corner - places[i]).norm() > kSame * (corner.norm() + places[i].norm())) continue;
    places[i] = corner;
    return i;
  }
  places.push_back(corner);
  return places.size() - 1;
}

}  // namespace

std::array<Eigen::Vector2d, 3> ClothMesh::restCorners(std::size_t triangle) const {
  std::array<Eigen::Vector2d, 3> corners;
  for (int i = 0; i < 3; ++i) {
    corners[i] = corner_coordinates.empty() ? rest_coordinates[triangles[triangle][i]]
                                            : corner_coordinates[triangle][i];
  }
  const double grain = panel(panelOf(triangle)).grain;
  if (grain == 0.0) return corners;
  const Eigen::Rotation2Dd into_fabric(-grain);
  for (Eigen::Vector2d& corner : corners) corner = into_fabric * corner;
  return corners;
}

CutPanel cutPanel(const ClothMesh& mesh, int panel) {
  std::vector<std::vector<Eigen::Vector2d>> places(mesh.rest_coordinates.size());
  std::vector<std::size_t> triangles;
  std::vector<std::array<std::size_t, 3>> place_of;  // of the corners of `triangles`
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.panelOf(t) != panel) continue;
    triangles.push_back(t);
    const std::array<Eigen::Vector2d, 3> corners = mesh.restCorners(t);
    std::array<std::size_t, 3>& of_corners = place_of.emplace_back();
    for (int i = 0; i < 3; ++i) {
      of_corners[i] = placeOf(corners[i], places[mesh.triangles[t][i]]);
    }
  }
  CutPanel cut;
  std::vector<int> first(places.size());  // of the sheet's particles
  for (std::size_t i = 0; i < places.size(); ++i) {
    first[i] = static_cast<int>(cut.particles.size());
    for (const Eigen::Vector2d& place : places[i]) {
      cut.particles.push_back(static_cast<int>(i));
      cut.sheet.initial_positions.push_back(mesh.initial_positions[i]);
      cut.sheet.rest_coordinates.push_back(place);
    }
  }
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    cut.sheet.triangle_fabrics.push_back(mesh.fabricOf(triangles[k]));
    std::array<int, 3>& triangle = cut.sheet.triangles.emplace_back();
    for (int i = 0; i < 3; ++i) {
      triangle[i] = first[mesh.triangles[triangles[k]][i]] + static_cast<int>(place_of[k][i]);
    }
  }
  return cut;
}

ClothMesh makeRectangle(double width, double height, int cells_u, int cells_v,
                        Triangulation triangulation) {
  requireLength("width", width);
  requireLength("height", height);
  requireCells("cells_u", cells_u);
  requireCells("cells_v", cells_v);
  ClothMesh mesh;
  for (int j = 0; j <= cells_v; ++j) {
    for (int i = 0; i <= cells_u; ++i) {
      const double u = width * i / cells_u;
      const double v = height * j / cells_v;
      mesh.rest_coordinates.emplace_back(u, v);
      mesh.initial_positions.emplace_back(0.0, u - 0.5 * width, v - height);
    }
  }
  for (int j = 0; j < cells_v; ++j) {
    for (int i = 0; i < cells_u; ++i) {
      const int a = j * (cells_u + 1) + i;  // (u, v)
      const int b = a + 1;                  // (u + du, v)
      const int c = a + cells_u + 1;        // (u, v + dv)
      const int d = c + 1;                  // (u + du, v + dv)
      const bool turned = triangulation == Triangulation::kAlternating && (i + j) % 2 == 1;
      if (turned) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({b, d, c});
      } else {
        mesh.triangles.push_back({a, b, d});
        mesh.triangles.push_back({a, d, c});
      }
    }
  }
  return mesh;
}

std::vector<Eigen::Vector3d> flatPositions(const ClothMesh& mesh) {
  std::vector<Eigen::Vector3d> positions;
  positions.reserve(mesh.rest_coordinates.size());
  for (const Eigen::Vector2d& rest : mesh.rest_coordinates) {
    positions.emplace_back(rest.x(), rest.y(), 0.0);
  }
  return positions;
}

void cutAsInSpace(ClothMesh& mesh) {
  mesh.rest_coordinates.assign(mesh.initial_positions.size(), Eigen::Vector2d::Zero());
  mesh.corner_coordinates.clear();
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d ab = mesh.initial_positions[b] - mesh.initial_positions[a];
    const Eigen::Vector3d ac = mesh.initial_positions[c] - mesh.initial_positions[a];
    const double along = ac.dot(ab) / ab.norm();
    const double across = std::sqrt(std::max(0.0, ac.squaredNorm() - along * along));
    mesh.corner_coordinates.push_back({Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(ab.norm(), 0.0),
                                       Eigen::Vector2d(along, across)});
  }
}

std::vector<int> sideParticles(const ClothMesh& mesh, Side side) {
  std::vector<int> particles;
  if (mesh.rest_coordinates.empty()) return particles;
  Eigen::Vector2d low = mesh.rest_coordinates.front();
  Eigen::Vector2d high = low;
  for (const Eigen::Vector2d& rest : mesh.rest_coordinates) {
    low = low.cwiseMin(rest);
    high = high.cwiseMax(rest);
  }
  const double margin = 1e-9 * (high - low).norm();
  const int axis = side == Side::kLeft || side == Side::kRight ? 0 : 1;
  const bool at_low = side == Side::kBottom || side == Side::kLeft;
  const double line = at_low ? low[axis] : high[axis];
  for (std::size_t i = 0; i < mesh.rest_coordinates.size(); ++i) {
    if (std::abs(mesh.rest_coordinates[i][axis] - line) <= margin) {
      particles.push_back(static_cast<int>(i));
    }
  }
  return particles;
}

bool MeshDefects::none() const {
  return !empty && !size_mismatch && !panel_mismatch && unknown_panels.empty() &&
         unsound_panels.empty() && unsound_fabrics.empty() && invalid_triangles.empty() &&
         degenerate_triangles.empty() && duplicate_triangles.empty() &&
         unreferenced_particles.empty() && non_finite_particles.empty();
}

std::string MeshDefects::description() const {
  std::ostringstream text;
  if (empty) text << "the mesh has no triangle";
  if (size_mismatch) {
    if (text.tellp() > 0) text << "; ";
    text << "rest coordinates and initial positions differ in number";
  }
  if (panel_mismatch) {
    if (text.tellp() > 0) text << "; ";
    text << "panels, corner coordinates or fabrics are not as many as triangles";
  }
  describe(text, "triangles with a particle that does not exist", invalid_triangles);
  describe(text, "triangles of a panel that does not exist", unknown_panels);
  describe(text, "panels of a fabric below 0 or with a grain that is not finite", unsound_panels);
  describe(text, "triangles of a fabric below 0", unsound_fabrics);
  describe(text, "degenerate triangles", degenerate_triangles);
  describe(text, "duplicate triangles", duplicate_triangles);
  describe(text, "particles in no triangle", unreferenced_particles);
  describe(text, "particles with a coordinate that is not finite", non_finite_particles);
  return text.str();
}

MeshDefects findDefects(const ClothMesh& mesh) {
  constexpr double kMinSlenderness = 1e-9;
  MeshDefects defects;
  defects.empty = mesh.triangles.empty();
  defects.size_mismatch = mesh.rest_coordinates.size() != mesh.initial_positions.size();
  findPanelDefects(mesh, defects);
  const bool panels_fit = !defects.panel_mismatch && defects.unknown_panels.empty();
  const int particles = static_cast<int>(mesh.rest_coordinates.size());
  for (int i = 0; i < particles; ++i) {
    const bool finite = mesh.rest_coordinates[i].allFinite() &&
                        (defects.size_mismatch || mesh.initial_positions[i].allFinite());
    if (!finite) defects.non_finite_particles.push_back(i);
  }
  std::vector<bool> referenced(particles, false);
  std::set<std::array<int, 3>> seen;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<int, 3> triangle = mesh.triangles[t];
    std::sort(triangle.begin(), triangle.end());
    if (triangle[0] < 0 || triangle[2] >= particles) {
      defects.invalid_triangles.push_back(static_cast<int>(t));
      continue;
    }
    for (int particle : triangle) referenced[particle] = true;
    if (!seen.insert(triangle).second) defects.duplicate_triangles.push_back(static_cast<int>(t));
    // Negated so that a rest coordinate that is not a number counts as degenerate.
    if (panels_fit && !(slenderness(mesh.restCorners(t)) >= kMinSlenderness)) {
      defects.degenerate_triangles.push_back(static_cast<int>(t));
    }
  }
  for (int i = 0; i < particles; ++i) {
    if (!referenced[i]) defects.unreferenced_particles.push_back(i);
  }
  return defects;
}

void requireSound(const ClothMesh& mesh) {
  const MeshDefects defects = findDefects(mesh);
  if (!defects.none()) throw std::invalid_argument(defects.description());
}

void requireFabrics(const ClothMesh& mesh, std::size_t count) {
  if (count < 1 || count > kMostFabrics) {
    throw std::invalid_argument("the cloth has " + std::to_string(count) +
                                " fabrics: allowed are 1 to " + std::to_string(kMostFabrics));
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (mesh.fabricOf(t) < static_cast<int>(count)) continue;
    throw std::invalid_argument("triangle " + std::to_string(t) + " is of fabric " +
                                std::to_string(mesh.fabricOf(t)) + "; there are " +
                                std::to_string(count));
  }
}

}  // namespace haptex::mesh
