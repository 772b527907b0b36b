#include "haptex/nodes/common/proximity_messages.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>

#include "haptex/base/quoted.h"
#include "haptex/mesh/merged_seams.h"
#include "haptex/nodes/common/cloth_messages.h"
#include "haptex/nodes/common/vector_messages.h"

namespace haptex::nodes {
namespace {

using Request = haptex::QueryProximity::Request;

constexpr int kAnyNumber = -1;

/// What goes with a shape.
struct Shape {
  const char* name;
  int points;
  int radii;  // kAnyNumber: one for each point
};

/// @throws std::invalid_argument if there is no such shape
Shape shapeOf(const Request& request) {
  switch (request.shape) {
    case Request::POINT:
      return {"POINT", 1, 0};
    case Request::SPHERES:
      return {"SPHERES", kAnyNumber, kAnyNumber};
    case Request::CAPSULE:
      return {"CAPSULE", 2, 1};
    case Request::TAPERED_CAPSULE:
      return {"TAPERED_CAPSULE", 2, 2};
    case Request::OBSTACLE:
      return {"OBSTACLE", 0, 0};
    default:
      throw std::invalid_argument("shape = " + std::to_string(request.shape) +
                                  ": allowed are POINT = 0, SPHERES = 1, CAPSULE = 2, "
                                  "TAPERED_CAPSULE = 3 and OBSTACLE = 4");
  }
}

bool isLength(double value) {
  return std::isfinite(value) && std::abs(value) <= proximity::kMaxLength;
}

void requirePlaces(const std::string& name, const std::vector<geometry_msgs::Point>& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (proximity::isPlace({points[i].x, points[i].y, points[i].z})) continue;
    std::ostringstream message;
    message << name << "[" << i << "] = (" << points[i].x << ", " << points[i].y << ", "
            << points[i].z << "): allowed are finite numbers up to " << proximity::kMaxLength
            << " m";
    throw std::invalid_argument(message.str());
  }
}

/// Lengths that are not negative.
void requireDistance(const std::string& name, double value) {
  if (isLength(value) && value >= 0.0) return;
  std::ostringstream message;
  message << name << " = " << value << ": allowed are finite numbers from 0 to "
          << proximity::kMaxLength << " m";
  throw std::invalid_argument(message.str());
}

void requireCount(const std::string& name, std::size_t count, int allowed, const Shape& shape) {
  if (count == static_cast<std::size_t>(allowed)) return;
  throw std::invalid_argument(name + " has " + std::to_string(count) + " elements: shape " +
                              shape.name + " takes " + std::to_string(allowed));
}

void requireCounts(const Request& request, const Shape& shape) {
  if (shape.points != kAnyNumber) {
    requireCount("points", request.points.size(), shape.points, shape);
    requireCount("radii", request.radii.size(), shape.radii, shape);
    return;
  }
  if (request.points.empty()) {
    throw std::invalid_argument(std::string("points is empty: shape ") + shape.name +
                                " takes one or more");
  }
  if (request.radii.size() != request.points.size()) {
    throw std::invalid_argument("radii has " + std::to_string(request.radii.size()) +
                                " elements: shape " + shape.name + " takes one for each of the " +
                                std::to_string(request.points.size()) + " points");
  }
}

NearElement elementMessage(const proximity::NearElement& element) {
  NearElement message;
  message.triangle = element.triangle;
  message.part = element.part;
  message.distance = element.distance;
  message.point = pointMessage(element.point);
  for (int i = 0; i < 3; ++i) message.barycentric[i] = element.barycentric[i];
  message.normal = vectorMessage(element.normal);
  return message;
}

void requireOneEach(const char* field, std::size_t count, std::size_t allowed,
                    const char* of_each) {
  if (count == allowed) return;
  throw std::invalid_argument(std::string(field) + " has " + std::to_string(count) +
                              " elements: allowed are none, or " + std::to_string(allowed) + ", " +
                              of_each);
}

/// Moves particles apart by the panels that they are first in.
void readPanels(const haptex::ClothMesh& message, RestMesh& mesh) {
  const std::vector<std::uint32_t>& panels = message.triangle_panels;
  if (panels.empty()) return;
  requireOneEach("triangle_panels", panels.size(), mesh.triangles.size(), "one per triangle");
  std::vector<char> is_placed(mesh.rest_coordinates.size(), 0);
  for (std::size_t t = 0; t < panels.size(); ++t) {
    if (panels[t] >= panels.size()) {
      throw std::invalid_argument(
          "triangle_panels[" + std::to_string(t) + "] = " + std::to_string(panels[t]) +
          ": allowed are 0 to one below the number of triangles, " + std::to_string(panels.size()));
    }
    mesh.panels.push_back(static_cast<int>(panels[t]));
    for (const int particle : mesh.triangles[t]) {
      if (is_placed[particle] == 0) mesh.rest_coordinates[particle].z() = panels[t];
      is_placed[particle] = 1;
    }
  }
}

void readCorners(const haptex::ClothMesh& message, RestMesh& mesh) {
  const std::vector<double>& weft = message.corner_weft_coordinates;
  const std::vector<double>& warp = message.corner_warp_coordinates;
  if (weft.empty() && warp.empty()) return;
  const std::size_t corners = message.triangles.size();
  requireOneEach("corner_weft_coordinates", weft.size(), corners, "three per triangle");
  requireOneEach("corner_warp_coordinates", warp.size(), corners, "three per triangle");
  mesh.corner_coordinates.resize(mesh.triangles.size());
  for (std::size_t i = 0; i < corners; ++i) {
    if (!isLength(weft[i]) || !isLength(warp[i])) {
      std::ostringstream text;
      text << "rest coordinates of corner " << i << " = (" << weft[i] << ", " << warp[i]
           << "): allowed are finite numbers up to " << proximity::kMaxLength << " m";
      throw std::invalid_argument(text.str());
    }
    mesh.corner_coordinates[i / 3][i % 3] = {weft[i], warp[i]};
  }
}

}  // namespace

RestMesh restMesh(const haptex::ClothMesh& message) {
  const std::vector<double>& weft = message.rest_weft_coordinates;
  const std::vector<double>& warp = message.rest_warp_coordinates;
  if (weft.size() != warp.size()) {
    throw std::invalid_argument("rest_weft_coordinates has " + std::to_string(weft.size()) +
                                " elements and rest_warp_coordinates " +
                                std::to_string(warp.size()) + ": allowed is one per particle");
  }
  if (message.triangles.empty() || message.triangles.size() % 3 != 0) {
    throw std::invalid_argument("triangles has " + std::to_string(message.triangles.size()) +
                                " elements: allowed are three per triangle, of one or more");
  }
  RestMesh mesh;
  mesh.number = message.mesh;
  mesh.triangles.resize(message.triangles.size() / 3);
  for (std::size_t i = 0; i < message.triangles.size(); ++i) {
    const std::uint32_t particle = message.triangles[i];
    if (particle >= weft.size()) {
      throw std::invalid_argument("triangles[" + std::to_string(i) +
                                  "] = " + std::to_string(particle) + ": there are " +
                                  std::to_string(weft.size()) + " particles");
    }
    mesh.triangles[i / 3][i % 3] = static_cast<int>(particle);
  }
  for (std::size_t i = 0; i < weft.size(); ++i) {
    if (!isLength(weft[i]) || !isLength(warp[i])) {
      std::ostringstream text;
      text << "rest coordinates of particle " << i << " = (" << weft[i] << ", " << warp[i]
           << "): allowed are finite numbers up to " << proximity::kMaxLength << " m";
      throw std::invalid_argument(text.str());
    }
    mesh.rest_coordinates.emplace_back(weft[i], warp[i], 0.0);
  }
  readPanels(message, mesh);
  readCorners(message, mesh);
  return mesh;
}

mesh::ClothMesh clothOf(const RestMesh& rest) {
  mesh::ClothMesh mesh;
  mesh.triangles = rest.triangles;
  for (const Eigen::Vector3d& place : rest.rest_coordinates) {
    mesh.rest_coordinates.emplace_back(place.x(), place.y());
    mesh.initial_positions.emplace_back(0.0, place.x(), place.y());
  }
  mesh.triangle_panels = rest.panels;
  if (!rest.panels.empty()) {
    mesh.panels.resize(1 + *std::max_element(rest.panels.begin(), rest.panels.end()));
  }
  mesh.corner_coordinates = rest.corner_coordinates;
  mesh::requireSound(mesh);
  if (!mesh.corner_coordinates.empty()) mesh::addHingesOfMergedSeams(mesh);
  return mesh;
}

void requireValid(const haptex::ClothState& message) {
  requireFixedFrame(message.header);
  requirePlaces("positions", message.positions);
}

void requireValid(const Request& request) {
  const Shape shape = shapeOf(request);
  requireCounts(request, shape);
  if (request.shape != Request::OBSTACLE && !request.obstacle.empty()) {
    throw std::invalid_argument("obstacle = " + base::quoted(request.obstacle) + " with shape " +
                                shape.name + ": leave it empty, or set the shape to OBSTACLE = 4");
  }
  requirePlaces("points", request.points);
  for (std::size_t i = 0; i < request.radii.size(); ++i) {
    requireDistance("radii[" + std::to_string(i) + "]", request.radii[i]);
  }
  requireDistance("distance", request.distance);
}

proximity::Cursor cursorInWorld(const Request& request, const Eigen::Isometry3d& world_from_frame) {
  std::vector<Eigen::Vector3d> places = fromMessage(request.points);
  for (Eigen::Vector3d& place : places) place = world_from_frame * place;
  switch (request.shape) {
    case Request::POINT:
      return proximity::Cursor::point(places[0]);
    case Request::CAPSULE:
      return proximity::Cursor::capsule(places[0], places[1], request.radii[0]);
    case Request::TAPERED_CAPSULE:
      return proximity::Cursor::taperedCapsule({places[0], request.radii[0]},
                                               {places[1], request.radii[1]});
    default: {
      std::vector<proximity::Sphere> spheres;
      for (std::size_t i = 0; i < places.size(); ++i) {
        spheres.push_back({places[i], request.radii[i]});
      }
      return proximity::Cursor::spheres(spheres);
    }
  }
}

void fillResponse(const std::vector<proximity::NearElement>& found, double asked,
                  haptex::QueryProximity::Response& response) {
  std::ostringstream message;
  if (found.empty()) {
    message << "no element";
  } else {
    message << found.size() << (found.size() == 1 ? " element" : " elements");
  }
  message << " within " << asked << " m";
  response.success = true;
  response.message = message.str();
  response.distance =
      found.empty() ? std::numeric_limits<double>::infinity() : found.front().distance;
  response.elements.reserve(found.size());
  for (const proximity::NearElement& element : found) {
    response.elements.push_back(elementMessage(element));
  }
}

haptex::QueryProximity::Response refusal(const std::string& message) {
  haptex::QueryProximity::Response response;
  response.success = false;
  response.message = message;
  response.distance = std::numeric_limits<double>::infinity();
  return response;
}

}  // namespace haptex::nodes
