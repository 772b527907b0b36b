#include "haptex/nodes/common/cloth_messages.h"

#include <stdexcept>

#include "haptex/base/quoted.h"
#include "haptex/nodes/common/transforms.h"
#include "haptex/nodes/common/vector_messages.h"
#include "haptex/nodes/wire/frame_names.h"

namespace haptex::nodes {
namespace {

template <typename Message>
void fillVectors(const std::vector<Eigen::Vector3d>& vectors, std::vector<Message>& messages) {
  messages.resize(vectors.size());
  for (std::size_t i = 0; i < vectors.size(); ++i) fillVector(vectors[i], messages[i]);
}

void appendRowByRow(const Eigen::Matrix3d& block, std::vector<double>& numbers) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) numbers.push_back(block(row, column));
  }
}

void fillPanels(const mesh::ClothMesh& mesh, haptex::ClothMesh& message) {
  const std::vector<int>& panels = mesh.triangle_panels;
  message.triangle_panels.assign(panels.begin(), panels.end());
  if (mesh.corner_coordinates.empty()) return;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const Eigen::Vector2d& corner : mesh.restCorners(t)) {
      message.corner_weft_coordinates.push_back(corner.x());
      message.corner_warp_coordinates.push_back(corner.y());
    }
  }
}

template <typename Message>
std::vector<Eigen::Vector3d> fromXyz(const std::vector<Message>& messages) {
  std::vector<Eigen::Vector3d> vectors;
  vectors.reserve(messages.size());
  for (const Message& message : messages) vectors.emplace_back(message.x, message.y, message.z);
  return vectors;
}

}  // namespace

haptex::ClothMesh meshMessage(const cloth::Cloth& cloth, std::uint32_t mesh,
                              const material::FabricFactors& factors, const ros::Time& stamp) {
  haptex::ClothMesh message;
  message.header.stamp = stamp;
  message.header.frame_id = fixedFrame();
  message.mesh = mesh;
  for (const material::Fabric& fabric : cloth.fabrics()) {
    message.fabrics.push_back(fabric.name);
    message.fabric_files.push_back(fabric.file);
  }
  message.factors = {factors.weft, factors.warp, factors.shear, factors.bending, factors.density};
  message.gravity = vectorMessage(cloth.effects().gravity);
  for (const Eigen::Vector2d& rest : cloth.mesh().rest_coordinates) {
    message.rest_weft_coordinates.push_back(rest.x());
    message.rest_warp_coordinates.push_back(rest.y());
  }
  for (const auto& triangle : cloth.mesh().triangles) {
    message.triangles.insert(message.triangles.end(), triangle.begin(), triangle.end());
  }
  fillPanels(cloth.mesh(), message);
  const std::vector<int>& fabrics = cloth.mesh().triangle_fabrics;
  message.triangle_fabrics.assign(fabrics.begin(), fabrics.end());
  message.masses = cloth.masses();
  return message;
}

void fillStateMessage(const simulation::SimulatedCloth& simulation, const ros::Time& stamp,
                      const std::vector<Eigen::Vector3d>& forces, haptex::ClothState& message) {
  const cloth::ClothState& state = simulation.state();
  restampStateMessage(simulation, stamp, message);
  message.header.frame_id = fixedFrame();
  fillVectors(state.positions, message.positions);
  fillVectors(state.velocities, message.velocities);
  fillVectors(forces, message.forces);
  message.bodies.clear();
  for (const contact::FreeBody& body : simulation.bodies()) {
    message.bodies.push_back(poseMessage(body.pose()));
  }
  message.attached.clear();
  const auto& attachments = simulation.cloth().attachments();
  for (std::size_t i = 0; i < attachments.size(); ++i) {
    if (attachments[i]) message.attached.push_back(static_cast<std::uint32_t>(i));
  }
  message.excluded.clear();
  const std::vector<char>& excluded = simulation.excluded();
  for (std::size_t i = 0; i < excluded.size(); ++i) {
    if (excluded[i] != 0) message.excluded.push_back(static_cast<std::uint32_t>(i));
  }
}

void restampStateMessage(const simulation::SimulatedCloth& simulation, const ros::Time& stamp,
                         haptex::ClothState& message) {
  message.header.stamp = stamp;
  message.step = simulation.steps();
  message.simulated_time = simulation.state().time;
}

void fillJacobianResponse(const std::vector<cloth::JacobianBlock>& blocks,
                          haptex::GetJacobian::Response& response) {
  for (const cloth::JacobianBlock& block : blocks) {
    response.rows.push_back(block.row);
    response.columns.push_back(block.column);
    appendRowByRow(block.by_position, response.by_position);
    appendRowByRow(block.by_velocity, response.by_velocity);
  }
}

void requireFixedFrame(const std_msgs::Header& header) {
  if (header.frame_id != fixedFrame()) {
    throw std::invalid_argument("header.frame_id = " + base::quoted(header.frame_id) +
                                ": allowed is '" + fixedFrame() + "'");
  }
}

std::vector<Eigen::Vector3d> fromMessage(const std::vector<geometry_msgs::Point>& points) {
  return fromXyz(points);
}

std::vector<Eigen::Vector3d> fromMessage(const std::vector<geometry_msgs::Vector3>& vectors) {
  return fromXyz(vectors);
}

}  // namespace haptex::nodes
