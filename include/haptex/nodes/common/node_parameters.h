// Reading the private parameters of a node.
#pragma once

#include <ros/node_handle.h>

#include <string>

#include "haptex/base/finger.h"
#include "haptex/exoskeleton/control/finger_kinematics.h"

namespace haptex::nodes {

/// @returns `fallback` if the parameter is not set
/// @throws std::invalid_argument naming the parameter, its value and what is allowed unless it is
///   finite and > 0
double readPositive(const ros::NodeHandle& private_node, const std::string& name, double fallback);

/// @returns false if the parameter is not set
/// @throws std::invalid_argument naming the parameter unless it is true or false
bool readSwitch(const ros::NodeHandle& private_node, const std::string& name);

/// @param allowed what the parameter may be, for the message
/// @throws std::invalid_argument naming the parameter and what is allowed unless it is set to a
///   string that is not empty
std::string readText(const ros::NodeHandle& private_node, const std::string& name,
                     const std::string& allowed);

/// Of a serial port or of the link that an emulator makes to its own. What has no slash is a name
/// in the working directory, and two graphs have different ones: what comes in the node's namespace
/// before its last part is put before it. @param space the namespace, as in
/// portOf("haptex_exoskeleton", "/left/haptex") == "left_haptex_exoskeleton"
std::string portOf(const std::string& text, const std::string& space);

/// The same of a parameter. @throws as readText()
std::string readPort(const ros::NodeHandle& private_node, const std::string& name,
                     const std::string& allowed);

/// A robot's URDF from the parameter robot_description of the nearest namespace that has one.
struct RobotDescription {
  std::string parameter;  ///< its full name
  std::string urdf;
};

/// @throws std::invalid_argument naming the parameter unless it is set to a string
RobotDescription readRobotDescription(const ros::NodeHandle& private_node);

/// @throws std::invalid_argument naming the parameter and what its URDF lacks
base::PerFinger<exoskeleton::FingerKinematics> kinematicsOf(const RobotDescription& description);

/// The path of a file from a parameter that is a path or a name in config/<directory>.
/// @throws std::invalid_argument naming the parameter if it is not set to a string or there is no
///   such file
std::string readConfigPath(const ros::NodeHandle& private_node, const std::string& name,
                           const std::string& directory);

/// The path of a scene file: ~scene, as readConfigPath().
std::string readScenePath(const ros::NodeHandle& private_node);

/// @param listed whether the scene lists the effect that the node is there for
/// @throws std::invalid_argument if not, naming scene, effect and node
void requireListed(const std::string& scene_path, bool listed, const std::string& effect,
                   const std::string& node);

}  // namespace haptex::nodes
