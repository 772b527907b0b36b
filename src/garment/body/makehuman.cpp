#include "haptex/garment/body/makehuman.h"

#include <utility>

#include "haptex/base/yaml_reader.h"

namespace haptex::garment {
namespace {

using Eigen::Vector3d;

Vector3d meanOf(const std::vector<Vector3d>& positions, const std::vector<int>& vertices) {
  Vector3d sum = Vector3d::Zero();
  for (const int vertex : vertices) sum += positions[vertex];
  return sum / static_cast<double>(vertices.size());
}

std::string read(const std::string& path) { return base::readTextFile(path, kLargestFigureFile); }

}  // namespace

Figure loadFigure(const std::string& directory) {
  const std::string obj = directory + "/base.obj";
  const std::string skeleton = directory + "/default.mhskel";
  const std::string weights = directory + "/default_weights.mhw";
  FigureMesh mesh = parseFigure(read(obj), obj);
  const std::size_t vertices = mesh.positions.size();
  return makeFigure(std::move(mesh), parseSkeleton(read(skeleton), skeleton, vertices),
                    read(weights), weights);
}

Target loadTarget(const std::string& path, std::size_t vertices) {
  return parseTarget(read(path), path, vertices);
}

Body bodyOf(const Figure& figure, const std::vector<Vector3d>& positions, double scale) {
  Body body;
  std::vector<int> places(positions.size(), -1);
  for (std::size_t i = 0; i < figure.surface.size(); ++i) {
    places[figure.surface[i]] = static_cast<int>(i);
  }
  for (const auto& [a, b, c] : figure.mesh.triangles) {
    body.triangles.push_back({places[a], places[b], places[c]});
  }
  body.vertices.resize(figure.surface.size());
  body.segments = figure.segments;
  body.shares = figure.shares;
  moveTo(figure, positions, scale, body);
  return body;
}

void moveTo(const Figure& figure, const std::vector<Vector3d>& positions, double scale,
            Body& body) {
  for (std::size_t i = 0; i < figure.surface.size(); ++i) {
    body.vertices[i] = scale * positions[figure.surface[i]];
  }
  for (std::size_t i = 0; i < figure.segments.size(); ++i) {
    body.segments[i].start = scale * meanOf(positions, figure.joints[i].start);
    body.segments[i].end = scale * meanOf(positions, figure.joints[i].end);
  }
  setDown(body);
}

}  // namespace haptex::garment
