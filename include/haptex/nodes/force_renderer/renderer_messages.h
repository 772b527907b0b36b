// Conversions between the contact room and the messages of msg/ and srv/. Messages come from
// outside: nothing in them is believed.
#pragma once

#include <haptex/ClothMesh.h>
#include <haptex/ClothState.h>
#include <haptex/Contact.h>
#include <haptex/ContactForces.h>
#include <haptex/QueryProximity.h>
#include <haptex/ServoForce.h>
#include <ros/time.h>

#include <Eigen/Core>
#include <vector>

#include "haptex/contact/contactors.h"
#include "haptex/contact/haptic_layer.h"
#include "haptex/contact/patch_selection.h"
#include "haptex/mesh/mesh.h"
#include "haptex/simulation/frame_follower.h"
#include "haptex/simulation/large_scale_state.h"

namespace haptex::nodes {

/// The mesh of a message, flat in the plane x = 0: a message has no initial positions.
/// @throws std::invalid_argument naming what is wrong with the message
mesh::ClothMesh clothMesh(const haptex::ClothMesh& message);

/// m/s^2. @throws std::invalid_argument unless it is finite and at most 1000 m/s^2
Eigen::Vector3d readGravity(const haptex::ClothMesh& message);

/// Allocates nothing once the vectors have their size.
/// @throws std::invalid_argument naming field, value and what is allowed: another frame than
///   fixedFrame(), arrays that do not fit together, an attached particle that does not exist, a
///   number that is not finite or beyond proximity::kMaxLength, a next step that is due before the
///   message or an hour after it; `state` is then undefined
void readState(const haptex::ClothState& message, simulation::LargeScaleState& state);

/// Fills in a command for the device, without allocation once the message has its frame.
/// @param gain share of the force that is rendered, 0 to 1
/// @param hand motion of hand_base in the world frame, with which the contact was computed
void fillServoForce(const contact::FingertipContact& contact, double gain,
                    const simulation::FrameMotion& hand, const ros::Time& stamp,
                    haptex::ServoForce& message);

/// Likewise. All zero without a gain.
void fillContact(const contact::FingertipContact& contact,
                 const tactile::PerContactor<double>& contactor_forces,
                 const tactile::ArrayPlacement& array, double gain, const ros::Time& stamp,
                 haptex::Contact& message);

/// What acts on the cloth.
void fillContactForces(const std::vector<cloth::PointLoad>& loads, const ros::Time& stamp,
                       haptex::ContactForces& message);

haptex::QueryProximity::Request volumeQuery(const contact::SearchVolume& volume);

/// Adds what an answer found to a round of a selection.
/// @param triangles of the mesh
/// @throws std::invalid_argument naming the field if a triangle does not exist
void addFound(const haptex::QueryProximity::Response& response, std::size_t triangles,
              const contact::HapticSettings& settings, contact::PatchSelection& selection);

}  // namespace haptex::nodes
