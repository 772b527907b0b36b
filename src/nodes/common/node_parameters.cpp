#include "haptex/nodes/common/node_parameters.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

#include "haptex/nodes/common/config_files.h"

namespace haptex::nodes {

double readPositive(const ros::NodeHandle& private_node, const std::string& name, double fallback) {
  if (!private_node.hasParam(name)) return fallback;
  double value = 0.0;
  const std::string full_name = private_node.resolveName(name);
  if (!private_node.getParam(name, value)) {
    throw std::invalid_argument("parameter " + full_name + " is not a number");
  }
  if (!std::isfinite(value) || value <= 0.0) {
    std::ostringstream message;
    message << "parameter " << full_name << " = " << value << ": allowed are finite numbers > 0";
    throw std::invalid_argument(message.str());
  }
  return value;
}

bool readSwitch(const ros::NodeHandle& private_node, const std::string& name) {
  bool value = false;
  if (private_node.hasParam(name) && !private_node.getParam(name, value)) {
    throw std::invalid_argument("parameter " + private_node.resolveName(name) +
                                " is not true or false");
  }
  return value;
}

std::string readText(const ros::NodeHandle& private_node, const std::string& name,
                     const std::string& allowed) {
  std::string text;
  if (!private_node.getParam(name, text) || text.empty()) {
    throw std::invalid_argument("parameter " + private_node.resolveName(name) +
                                " is not set to a string: allowed is " + allowed);
  }
  return text;
}

std::string portOf(const std::string& text, const std::string& space) {
  if (text.find('/') != std::string::npos) return text;
  std::string name = text;
  // From the outermost part on, without the last one, which every graph has.
  for (std::size_t end = space.rfind('/'); end != std::string::npos && end > 0;) {
    const std::size_t begin = space.rfind('/', end - 1);
    name = space.substr(begin + 1, end - begin - 1) + "_" + name;
    end = begin;
  }
  return name;
}

std::string readPort(const ros::NodeHandle& private_node, const std::string& name,
                     const std::string& allowed) {
  return portOf(readText(private_node, name, allowed), ros::this_node::getNamespace());
}

RobotDescription readRobotDescription(const ros::NodeHandle& private_node) {
  RobotDescription description;
  if (!private_node.searchParam("robot_description", description.parameter)) {
    throw std::invalid_argument(
        "parameter robot_description is not set: it is to be the text of the exoskeleton's URDF");
  }
  if (!private_node.getParam(description.parameter, description.urdf)) {
    throw std::invalid_argument("parameter " + description.parameter +
                                " is not a string: it is to be the text of the exoskeleton's URDF");
  }
  return description;
}

base::PerFinger<exoskeleton::FingerKinematics> kinematicsOf(const RobotDescription& description) {
  using base::Finger;
  using exoskeleton::FingerKinematics;
  try {
    return {{FingerKinematics(description.urdf, Finger::kIndex),
             FingerKinematics(description.urdf, Finger::kThumb)}};
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("parameter " + description.parameter + ": " + error.what());
  }
}

std::string readConfigPath(const ros::NodeHandle& private_node, const std::string& name,
                           const std::string& directory) {
  const std::string full_name = private_node.resolveName(name);
  std::string value;
  if (!private_node.getParam(name, value)) {
    throw std::invalid_argument("parameter " + full_name +
                                " is not set to a string: allowed is the path of a file or the "
                                "name of one in config/" +
                                directory);
  }
  try {
    return findConfigFile(directory, value);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("parameter " + full_name + ": " + error.what());
  }
}

void requireListed(const std::string& scene_path, bool listed, const std::string& effect,
                   const std::string& node) {
  if (listed) return;
  throw std::invalid_argument(scene_path + ": model: does not list " + effect +
                              ", so there is nothing to do for " + node +
                              ": list it, or do without " + node);
}

std::string readScenePath(const ros::NodeHandle& private_node) {
  return readConfigPath(private_node, "scene", "scenes");
}

}  // namespace haptex::nodes
