// Messages in the panel's words.
#pragma once

#include <diagnostic_msgs/DiagnosticStatus.h>
#include <haptex/ClothQuality.h>

#include <string>

#include "haptex/nodes/rviz_plugin/system_status.h"

namespace haptex::nodes {

/// The status's name without its node's, for example "force loop" of
/// "haptex/force_renderer: force loop"; empty if the node is not in the namespace.
/// @param space as ros::this_node::getNamespace(), for example "/haptex"
std::string statusOfNamespace(const std::string& name, const std::string& space);

/// Texts are cut off after kLongest characters. @param stamp of the array, s
/// @param sender the node that sent it, for example "/haptex/force_renderer"
Diagnosis diagnosisOf(const diagnostic_msgs::DiagnosticStatus& status, double stamp,
                      const std::string& sender);
constexpr std::size_t kLongest = 400;

/// What runs and the errors to expect, in lines.
std::string qualityText(const haptex::ClothQuality& quality);

}  // namespace haptex::nodes
