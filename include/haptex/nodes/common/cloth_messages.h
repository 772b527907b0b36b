// Conversions between the cloth room and the messages of msg/ and srv/.
#pragma once

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Vector3.h>
#include <haptex/ClothMesh.h>
#include <haptex/ClothState.h>
#include <haptex/GetJacobian.h>
#include <ros/time.h>
#include <std_msgs/Header.h>

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/material/fabric_factors.h"
#include "haptex/simulation/simulated_cloth.h"

namespace haptex::nodes {

/// @param mesh  the number of the mesh @param factors that the fabrics have on their files
/// @param stamp when all of it became so
haptex::ClothMesh meshMessage(const cloth::Cloth& cloth, std::uint32_t mesh,
                              const material::FabricFactors& factors, const ros::Time& stamp);

/// Fills a state message in place but for until_next, without allocation once its arrays have their
/// size.
/// @param stamp  when the state was computed
/// @param forces on the particles of the state (N): Cloth::computeForces()
void fillStateMessage(const simulation::SimulatedCloth& simulation, const ros::Time& stamp,
                      const std::vector<Eigen::Vector3d>& forces, haptex::ClothState& message);

/// Only what changes while the cloth sleeps: stamp, step and simulated time.
/// @param message filled with the same state before
void restampStateMessage(const simulation::SimulatedCloth& simulation, const ros::Time& stamp,
                         haptex::ClothState& message);

/// Writes blocks into the arrays of a response.
void fillJacobianResponse(const std::vector<cloth::JacobianBlock>& blocks,
                          haptex::GetJacobian::Response& response);

/// @throws std::invalid_argument unless frame_id is fixedFrame()
void requireFixedFrame(const std_msgs::Header& header);

std::vector<Eigen::Vector3d> fromMessage(const std::vector<geometry_msgs::Point>& points);
std::vector<Eigen::Vector3d> fromMessage(const std::vector<geometry_msgs::Vector3>& vectors);

}  // namespace haptex::nodes
