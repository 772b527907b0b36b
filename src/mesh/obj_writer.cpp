#include "haptex/mesh/obj_writer.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>
#include <map>
#include <ostream>

#include "haptex/base/quoted.h"
#include "haptex/base/require.h"

namespace haptex::mesh {
namespace {

void requireNames(const ClothMesh& mesh, const std::vector<std::string>& names) {
  if (static_cast<int>(names.size()) != mesh.panelCount()) {
    base::refuse("there are ", names.size(), " names for ", mesh.panelCount(),
                 " panels: allowed is one each");
  }
  for (const std::string& name : names) {
    const bool sound = !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
      return std::isgraph(static_cast<unsigned char>(c)) != 0 || (c & 0x80) != 0;
    });
    if (sound) continue;
    base::refuse("panel ", base::quoted(name),
                 " cannot be named in an OBJ file: allowed are names without blanks and control "
                 "characters");
  }
}

}  // namespace

void writeObjPositions(const std::vector<Eigen::Vector3d>& positions, std::ostream& out) {
  out.precision(std::numeric_limits<double>::max_digits10);
  for (const Eigen::Vector3d& at : positions) {
    out << "v " << at.x() << ' ' << at.y() << ' ' << at.z() << '\n';
  }
}

void writeObj(const ObstacleMesh& surface, std::ostream& out) {
  writeObjPositions(surface.vertices, out);
  for (const auto& [a, b, c] : surface.triangles) {
    out << "f " << a + 1 << ' ' << b + 1 << ' ' << c + 1 << '\n';
  }
}

void writeObj(const ClothMesh& mesh, const std::vector<std::string>& names, std::ostream& out) {
  requireNames(mesh, names);
  writeObjPositions(mesh.initial_positions, out);
  int textures = 0;
  for (int panel = 0; panel < mesh.panelCount(); ++panel) {
    out << "g " << names[panel] << '\n';
    // A particle of a merged dart has two rest coordinates in its panel.
    std::map<std::pair<int, std::array<double, 2>>, int> texture_of;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (mesh.panelOf(t) != panel) continue;
      const std::array<Eigen::Vector2d, 3> corners = mesh.restCorners(t);
      std::array<int, 3> texture;
      for (int i = 0; i < 3; ++i) {
        const std::array<double, 2> rest = {corners[i].x(), corners[i].y()};
        const auto known = texture_of.find({mesh.triangles[t][i], rest});
        if (known != texture_of.end()) {
          texture[i] = known->second;
          continue;
        }
        out << "vt " << rest[0] << ' ' << rest[1] << '\n';
        texture[i] = texture_of[{mesh.triangles[t][i], rest}] = ++textures;
      }
      out << 'f';
      for (int i = 0; i < 3; ++i) out << ' ' << mesh.triangles[t][i] + 1 << '/' << texture[i];
      out << '\n';
    }
  }
}

}  // namespace haptex::mesh
