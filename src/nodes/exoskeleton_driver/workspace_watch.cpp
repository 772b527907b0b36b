#include "haptex/nodes/exoskeleton_driver/workspace_watch.h"

#include <visualization_msgs/MarkerArray.h>

#include "haptex/nodes/markers/workspace_markers.h"

namespace haptex::nodes {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using exoskeleton::Finger;
using exoskeleton::ReachRim;

}  // namespace

WorkspaceWatch::WorkspaceWatch(const ros::NodeHandle& node, const std::string& urdf)
    : node_(node),
      sides_{{Side{ReachRim(urdf, Finger::kIndex)}, Side{ReachRim(urdf, Finger::kThumb)}}} {
  marker_publisher_ = node_.advertise<visualization_msgs::MarkerArray>(
      "exoskeleton/workspace_markers", 1, [urdf](const ros::SingleSubscriberPublisher& subscriber) {
        subscriber.publish(workspaceMarkers(urdf));
      });
}

void WorkspaceWatch::diagnose(Finger finger, const exoskeleton::FingerMeasurement& measured,
                              bool is_homed, const std::optional<Eigen::Isometry3d>& hand,
                              diagnostic_updater::DiagnosticStatusWrapper& status) {
  if (!is_homed) {
    status.summary(DiagnosticStatus::OK, "not known before the device is homed");
    return;
  }
  Side& side = sides_[finger];
  const double to_reach = side.rim.distance(measured.joint_angles);
  status.summary(DiagnosticStatus::OK, "within the workspace and what is reached of it");
  if (side.reach.update(to_reach)) {
    status.summaryf(DiagnosticStatus::WARN,
                    "a joint is at its limit or the finger straight: %.1f mm are left",
                    1e3 * to_reach);
  }
  status.add("to the rim of what the fingertip reaches (mm)", 1e3 * to_reach);
  if (!hand) {
    status.mergeSummary(DiagnosticStatus::WARN, "where it is in the workspace is not known: no tf");
    return;
  }
  const Eigen::Vector3d place = *hand * measured.pose.translation();
  const double to_rim = exoskeleton::distanceToWorkspaceRim(place);
  if (side.workspace.update(to_rim)) {
    status.mergeSummaryf(DiagnosticStatus::WARN, "%s the workspace of %.0f mm: %.1f mm are left",
                         to_rim < 0.0 ? "outside of" : "near the rim of",
                         1e3 * exoskeleton::kWorkspaceSide, 1e3 * to_rim);
  }
  status.add("to the rim of the workspace (mm)", 1e3 * to_rim);
}

}  // namespace haptex::nodes
