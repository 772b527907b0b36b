// What does a seam cost? A square sheet of 0.5 m that hangs by two corners and swings, in one piece
// and of two halves: sewn by ties with matched and with unmatched edges, and merged. Per case and
// number of triangles:
//   seams/<case>/<triangles>        computing time of a step
//   seams/<case>/<triangles>/ratio  over that of the sheet in one piece per triangle, in turns with
//                                   it, the shortest turn of each
#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/material/linear_fabric.h"
#include "haptex/mesh/seam.h"
#include "haptex/simulation/step_cost.h"
#include "tab_lines.h"

namespace {

using namespace haptex;

constexpr double kSize = 0.5;     // m
constexpr double kStep = 0.0125;  // s
constexpr int kSteps = 30;
constexpr int kRounds = 5;

mesh::ClothMesh inOnePiece(int cells) {
  mesh::ClothMesh sheet =
      mesh::makeRectangle(kSize, kSize, cells, cells, mesh::Triangulation::kAlternating);
  sheet.initial_positions = mesh::flatPositions(sheet);
  return sheet;
}

/// Halves beside each other. @param seam between them
mesh::ClothMesh halves(int cells, int other_cells, mesh::Seam& seam) {
  mesh::ClothMesh sheet;
  for (int side = 0; side < 2; ++side) {
    const mesh::ClothMesh half =
        mesh::makeRectangle(0.5 * kSize, kSize, cells / 2, side == 0 ? cells : other_cells,
                            mesh::Triangulation::kAlternating);
    const int before = static_cast<int>(sheet.rest_coordinates.size());
    for (const Eigen::Vector2d& rest : half.rest_coordinates) {
      sheet.rest_coordinates.emplace_back(rest.x() + 0.5 * kSize * side, rest.y());
    }
    for (const auto& [a, b, c] : half.triangles) {
      sheet.triangles.push_back({a + before, b + before, c + before});
      sheet.triangle_panels.push_back(side);
    }
    std::vector<int>& edge = side == 0 ? seam.first : seam.second;
    for (const int particle :
         mesh::sideParticles(half, side == 0 ? mesh::Side::kRight : mesh::Side::kLeft)) {
      edge.push_back(particle + before);
    }
  }
  sheet.panels = {{0, 0.0}, {0, 0.0}};
  sheet.initial_positions = mesh::flatPositions(sheet);
  return sheet;
}

mesh::ClothMesh tied(int cells, int other_cells) {
  mesh::Seam seam;
  mesh::ClothMesh sheet = halves(cells, other_cells, seam);
  mesh::sew(sheet, {seam});
  return sheet;
}

mesh::ClothMesh merged(int cells, int other_cells) {
  mesh::Seam seam;
  const mesh::ClothMesh sheet = halves(cells, other_cells, seam);
  return mesh::merge(sheet, {seam}).mesh;
}

class SwingingSheet {
 public:
  explicit SwingingSheet(const mesh::ClothMesh& mesh)
      : cloth_(mesh, fabric(), effects()), start_(cloth_.initialState()), integrator_(cloth_, {}) {
    for (const mesh::Side side : {mesh::Side::kLeft, mesh::Side::kRight}) {
      const int corner = mesh::sideParticles(mesh, side).back();
      cloth_.attach(corner, {start_.positions[corner]});
    }
  }

  double triangles() const { return static_cast<double>(cloth_.mesh().triangles.size()); }

  /// s, of a step.
  double seconds() {
    cloth::ClothState state = start_;
    const double begin = simulation::threadSeconds();
    for (int i = 0; i < kSteps; ++i) integrator_.step(cloth_, state, kStep);
    return (simulation::threadSeconds() - begin) / kSteps;
  }

 private:
  static material::Fabric fabric() {
    material::Fabric linear = material::linearFabric(100.0, 0.1);
    linear.bending = {1e-5, 1e-5};
    return linear;
  }
  static cloth::ModelledEffects effects() {
    cloth::ModelledEffects effects;
    effects.gravity = {0.0, 0.0, -9.81};
    effects.viscosity = effects.bending = true;
    return effects;
  }

  cloth::Cloth cloth_;
  cloth::ClothState start_;
  cloth::Integrator integrator_;
};

void printCase(const std::string& name, const mesh::ClothMesh& mesh, int cells) {
  SwingingSheet sewn(mesh), whole(inOnePiece(cells));
  double shortest = std::numeric_limits<double>::infinity(), of_whole = shortest;
  for (int round = 0; round < kRounds; ++round) {
    of_whole = std::min(of_whole, whole.seconds());
    shortest = std::min(shortest, sewn.seconds());
  }
  const std::string line =
      "seams/" + name + "/" + std::to_string(static_cast<int>(sewn.triangles()));
  bench::printLine(line, 1e3 * shortest, "ms");
  bench::printLine(line + "/ratio", shortest / sewn.triangles() / (of_whole / whole.triangles()),
                   "1");
}

}  // namespace

int main() {
  for (const int cells : {32, 64}) {
    printCase("whole", inOnePiece(cells), cells);
    printCase("tied_matched", tied(cells, cells), cells);
    printCase("tied_unmatched", tied(cells, 5 * cells / 4), cells);
    printCase("merged_unmatched", merged(cells, 5 * cells / 4), cells);
  }
}
