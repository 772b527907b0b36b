// Messages of a cloth for tests of what is made of them.
#pragma once

#include <haptex/ClothMesh.h>
#include <haptex/ClothState.h>
#include <haptex/QueryProximity.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "haptex/mesh/mesh.h"
#include "haptex/nodes/common/cloth_messages.h"
#include "haptex/nodes/common/vector_messages.h"
#include "haptex/nodes/proximity/cloth_proximity.h"
#include "haptex/nodes/wire/frame_names.h"

namespace haptex::nodes {

constexpr int kTestCells = 8;      // along weft and warp
constexpr double kTestSize = 0.2;  // m

inline mesh::ClothMesh testMesh(int cells = kTestCells) {
  return mesh::makeRectangle(kTestSize, kTestSize, cells, cells, mesh::Triangulation::kAlternating);
}

inline haptex::ClothMesh testMeshMessage(const mesh::ClothMesh& mesh) {
  haptex::ClothMesh message;
  message.header.frame_id = fixedFrame();
  for (const Eigen::Vector2d& rest : mesh.rest_coordinates) {
    message.rest_weft_coordinates.push_back(rest.x());
    message.rest_warp_coordinates.push_back(rest.y());
  }
  for (const auto& triangle : mesh.triangles) {
    message.triangles.insert(message.triangles.end(), triangle.begin(), triangle.end());
  }
  message.masses.assign(mesh.rest_coordinates.size(), 1e-3);
  return message;
}

inline std::vector<Eigen::Vector3d> translated(std::vector<Eigen::Vector3d> positions,
                                               const Eigen::Vector3d& displacement) {
  for (Eigen::Vector3d& position : positions) position += displacement;
  return positions;
}

/// Waves of 3 cm.
inline std::vector<Eigen::Vector3d> wavy(std::vector<Eigen::Vector3d> positions) {
  for (Eigen::Vector3d& position : positions) {
    position.x() += 0.03 * std::sin(40.0 * position.y() + 25.0 * position.z());
  }
  return positions;
}

/// The stamp tells the step.
inline haptex::ClothStatePtr testState(std::uint32_t step,
                                       const std::vector<Eigen::Vector3d>& positions) {
  const haptex::ClothStatePtr message(new haptex::ClothState);
  message->header.frame_id = fixedFrame();
  message->header.stamp = ros::Time(1000 + step);
  message->step = step;
  for (const Eigen::Vector3d& position : positions) {
    message->positions.push_back(pointMessage(position));
  }
  message->velocities.resize(positions.size());
  message->forces.resize(positions.size());
  return message;
}

inline haptex::QueryProximity::Request testRequest(std::uint8_t shape,
                                                   const std::vector<Eigen::Vector3d>& points,
                                                   const std::vector<double>& radii,
                                                   double distance) {
  haptex::QueryProximity::Request request;
  request.header.frame_id = fixedFrame();
  request.shape = shape;
  for (const Eigen::Vector3d& point : points) request.points.push_back(pointMessage(point));
  request.radii = radii;
  request.distance = distance;
  return request;
}

inline Eigen::Isometry3d worldFrame() { return Eigen::Isometry3d::Identity(); }

}  // namespace haptex::nodes
