#include "haptex/nodes/force_renderer/renderer_messages.h"

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

#include "haptex/nodes/common/cloth_messages.h"
#include "haptex/nodes/common/driver_messages.h"
#include "haptex/nodes/common/proximity_messages.h"
#include "haptex/nodes/common/vector_messages.h"
#include "haptex/nodes/wire/frame_names.h"

namespace haptex::nodes {
namespace {

using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

constexpr double kFastest = 1e4;         // m/s, of a cloth
constexpr double kLargestGravity = 1e3;  // m/s^2
constexpr double kLongestStep = 3600.0;  // s, of the steady clock, likewise

/// Without allocation if it is that frame already.
void setHeader(const ros::Time& stamp, const std::string& frame, std_msgs::Header& header) {
  header.stamp = stamp;
  if (header.frame_id != frame) header.frame_id = frame;
}

void requireCount(const char* name, std::size_t count, std::size_t particles) {
  if (count == particles) return;
  throw std::invalid_argument(std::string(name) + " has " + std::to_string(count) +
                              " elements: positions has " + std::to_string(particles));
}

void requireTriangleFabrics(const haptex::ClothMesh& message, std::size_t triangles) {
  const std::vector<std::uint8_t>& fabrics = message.triangle_fabrics;
  if (fabrics.size() != triangles) {
    throw std::invalid_argument("triangle_fabrics has " + std::to_string(fabrics.size()) +
                                " elements: allowed are none, or one per triangle, of which there "
                                "are " +
                                std::to_string(triangles));
  }
  for (std::size_t t = 0; t < fabrics.size(); ++t) {
    if (fabrics[t] < message.fabrics.size()) continue;
    throw std::invalid_argument("triangle_fabrics[" + std::to_string(t) +
                                "] = " + std::to_string(fabrics[t]) + ": there are " +
                                std::to_string(message.fabrics.size()) + " fabrics");
  }
}

void readVelocities(const haptex::ClothState& message, simulation::LargeScaleState& state) {
  for (std::size_t i = 0; i < message.velocities.size(); ++i) {
    const geometry_msgs::Vector3& velocity = message.velocities[i];
    state.velocities[i] = {velocity.x, velocity.y, velocity.z};
    if (state.velocities[i].allFinite() && state.velocities[i].norm() <= kFastest) continue;
    std::ostringstream text;
    text << "velocities[" << i << "] = (" << state.velocities[i].transpose()
         << "): allowed are finite numbers up to " << kFastest << " m/s";
    throw std::invalid_argument(text.str());
  }
}

}  // namespace

mesh::ClothMesh clothMesh(const haptex::ClothMesh& message) {
  const RestMesh rest = restMesh(message);
  const std::vector<std::uint8_t>& fabrics = message.triangle_fabrics;
  if (!fabrics.empty()) requireTriangleFabrics(message, rest.triangles.size());
  mesh::ClothMesh mesh = clothOf(rest);
  mesh.triangle_fabrics.assign(fabrics.begin(), fabrics.end());
  return mesh;
}

Eigen::Vector3d readGravity(const haptex::ClothMesh& message) {
  const Eigen::Vector3d gravity = fromMessage(message.gravity);
  if (gravity.allFinite() && gravity.norm() <= kLargestGravity) return gravity;
  std::ostringstream text;
  text << "gravity = (" << gravity.transpose() << "): allowed are finite numbers up to "
       << kLargestGravity << " m/s2";
  throw std::invalid_argument(text.str());
}

void readState(const haptex::ClothState& message, simulation::LargeScaleState& state) {
  requireValid(message);
  if (!std::isfinite(message.simulated_time)) {
    throw std::invalid_argument("simulated_time is not finite");
  }
  if (!(message.until_next >= 0.0 && message.until_next <= kLongestStep)) {
    std::ostringstream text;
    text << "until_next = " << message.until_next << " s: allowed are numbers from 0 to "
         << kLongestStep;
    throw std::invalid_argument(text.str());
  }
  state.mesh = message.mesh;
  const std::size_t particles = message.positions.size();
  requireCount("velocities", message.velocities.size(), particles);
  state.positions.resize(particles);
  state.velocities.resize(particles);
  for (std::size_t i = 0; i < particles; ++i) {
    const geometry_msgs::Point& position = message.positions[i];
    state.positions[i] = {position.x, position.y, position.z};
  }
  readVelocities(message, state);
  state.attached.assign(particles, 0);
  for (const std::uint32_t particle : message.attached) {
    if (particle >= particles) {
      throw std::invalid_argument("attached has " + std::to_string(particle) + ": there are " +
                                  std::to_string(particles) + " particles");
    }
    state.attached[particle] = 1;
  }
  state.simulated_time = message.simulated_time;
  state.until_next = message.until_next;
}

void fillServoForce(const contact::FingertipContact& contact, double gain,
                    const simulation::FrameMotion& hand, const ros::Time& stamp,
                    haptex::ServoForce& message) {
  setHeader(stamp, handFrame(), message.header);
  const Eigen::Matrix3d to_hand = hand.pose.linear().transpose();
  const Eigen::Vector3d arm = contact.position - hand.pose.translation();
  const Eigen::Vector3d carried = hand.velocity + hand.angular_velocity.cross(arm);
  message.force = vectorMessage(gain * (to_hand * contact.force));
  message.position = pointMessage(to_hand * arm);
  message.velocity = vectorMessage(to_hand * (contact.velocity - carried));
  Eigen::Map<RowMajor>(message.stiffness.data()) =
      gain * (to_hand * contact.stiffness * to_hand.transpose());
  Eigen::Map<RowMajor>(message.damping.data()) =
      gain * (to_hand * contact.damping * to_hand.transpose());
}

void fillContact(const contact::FingertipContact& contact,
                 const tactile::PerContactor<double>& contactor_forces,
                 const tactile::ArrayPlacement& array, double gain, const ros::Time& stamp,
                 haptex::Contact& message) {
  setHeader(stamp, fixedFrame(), message.header);
  static const contact::FingertipContact no_contact;
  const contact::FingertipContact& shown = gain > 0.0 ? contact : no_contact;
  message.touching = shown.touching;
  message.fabric = static_cast<std::uint8_t>(shown.fabric);
  message.slipping = shown.slipping;
  message.force = vectorMessage(gain * shown.force);
  message.centre = pointMessage(shown.centre);
  message.normal = vectorMessage(shown.normal);
  message.normal_force = gain * shown.normal_force;
  message.area = shown.area;
  message.penetration = shown.penetration;
  message.sliding_velocity = vectorMessage(shown.sliding_velocity);
  for (int i = 0; i < 2; ++i) {
    message.fabric_position[i] = shown.fabric_position[i];
    message.fabric_velocity[i] = shown.fabric_velocity[i];
    message.array_origin[i] = gain > 0.0 ? array.origin[i] : 0.0;
    message.array_x[i] = gain > 0.0 ? array.axes(i, 0) : 0.0;
    message.array_y[i] = gain > 0.0 ? array.axes(i, 1) : 0.0;
  }
  for (std::size_t i = 0; i < contactor_forces.size(); ++i) {
    message.contactor_forces[i] = gain * contactor_forces[i];
  }
}

void fillContactForces(const std::vector<cloth::PointLoad>& loads, const ros::Time& stamp,
                       haptex::ContactForces& message) {
  setHeader(stamp, fixedFrame(), message.header);
  const std::size_t count = loads.size();
  message.triangles.resize(count);
  message.barycentric.resize(3 * count);
  message.positions.resize(count);
  message.forces.resize(count);
  message.stiffness.resize(9 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const cloth::PointLoad& load = loads[i];
    message.triangles[i] = static_cast<std::uint32_t>(load.triangle);
    message.positions[i] = pointMessage(load.position);
    message.forces[i] = vectorMessage(load.force);
    Eigen::Map<Eigen::Vector3d>(&message.barycentric[3 * i]) = load.weights;
    Eigen::Map<RowMajor>(&message.stiffness[9 * i]) = load.stiffness;
  }
}

haptex::QueryProximity::Request volumeQuery(const contact::SearchVolume& volume) {
  haptex::QueryProximity::Request request;
  request.header.frame_id = fixedFrame();
  request.shape = haptex::QueryProximity::Request::CAPSULE;
  request.points = {pointMessage(volume.begin), pointMessage(volume.end)};
  request.radii = {volume.radius};
  request.distance = volume.distance;
  request.nearest = static_cast<std::uint32_t>(volume.count);
  return request;
}

void addFound(const haptex::QueryProximity::Response& response, std::size_t triangles,
              const contact::HapticSettings& settings, contact::PatchSelection& selection) {
  for (std::size_t i = 0; i < response.elements.size(); ++i) {
    const haptex::NearElement& element = response.elements[i];
    if (element.triangle >= triangles) {
      throw std::invalid_argument("elements has the triangle " + std::to_string(element.triangle) +
                                  ": the mesh has " + std::to_string(triangles));
    }
    selection.add(static_cast<int>(element.triangle), element.distance, static_cast<int>(i),
                  settings);
  }
}

}  // namespace haptex::nodes
