// The program count_intersections: how many pairs of triangles intersect, by the exact test of
// haptex/proximity/intersections.h. Needs no ROS master.
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "haptex/base/command_line.h"
#include "haptex/mesh/obj_file.h"
#include "haptex/nodes/common/cloth_messages.h"
#include "haptex/nodes/common/cloth_recording.h"
#include "haptex/proximity/intersections.h"

namespace {

using namespace haptex;

constexpr const char* kUsage =
    "usage: count_intersections FILE\n"
    "FILE is an OBJ file (.obj) or a bag (.bag) with cloth/mesh and cloth/state.\n"
    "Prints how many pairs of triangles intersect beyond the vertices and edges that they share;\n"
    "of a bag the most that one of its states has, and which state has them first.\n";

void countInObj(const std::string& path) {
  const mesh::ObstacleMesh mesh = mesh::loadObjSurface(path);
  std::printf("%zu\n", proximity::countIntersections(mesh.vertices, mesh.triangles));
}

void countInBag(const std::string& path) {
  std::size_t states = 0, intersecting = 0;
  std::vector<proximity::TrianglePair> worst;
  unsigned long long step = 0;
  double time = 0.0;
  nodes::readClothRecording(path, [&](const ClothState& state, const nodes::Triangles& triangles) {
    auto pairs = proximity::intersectingTriangles(nodes::fromMessage(state.positions), triangles);
    ++states;
    if (pairs.empty()) return;
    ++intersecting;
    if (pairs.size() <= worst.size()) return;
    worst = std::move(pairs);
    step = state.step;
    time = state.simulated_time;
  });
  std::printf("%zu\n", worst.size());
  if (worst.empty()) {
    std::printf("none in %zu states\n", states);
    return;
  }
  std::printf("at step %llu, %.6f s, triangles %d and %d the first; %zu of %zu states intersect\n",
              step, time, worst[0][0], worst[0][1], intersecting, states);
}

void count(const std::string& path) {
  const std::string extension = std::filesystem::path(path).extension().string();
  if (extension == ".obj") {
    countInObj(path);
  } else if (extension == ".bag") {
    countInBag(path);
  } else {
    throw std::invalid_argument(path + ": must end in .obj or .bag");
  }
}

}  // namespace

int main(int argc, char** argv) {
  return base::runPlainProgram("count_intersections", kUsage, {argv + 1, argv + argc}, 1, 1,
                               [](const auto& arguments) { count(arguments[0]); });
}
