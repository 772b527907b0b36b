// Proximity queries and the volume hierarchy as rviz markers.
#pragma once

#include <ros/time.h>
#include <visualization_msgs/MarkerArray.h>

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "haptex/mesh/obstacle.h"
#include "haptex/nodes/proximity/cloth_proximity.h"
#include "haptex/proximity/cursor.h"

namespace haptex::nodes {

/// Markers in the frame fixedFrame(), in namespaces that rviz can switch off singly:
/// "near_elements": the elements of an answer in red, on both sides of the cloth and a little off
///   it, so that they are seen through neither of two coincident surfaces.
/// "cursor": the volume that was asked about, translucent; a point as a small ball.
/// "volumes", "volumes/0", ... and "tested_volumes" (VolumeGroup): polytopes of the hierarchy with
///   translucent faces and their edges; volumes of one level have colours of their own, those that
///   were tested that of their level.
/// "obstacles": the rigid bodies of the scene that rest; ClothMarkers shows those that move.
class ProximityMarkers {
 public:
  /// @param obstacles in the world frame
  explicit ProximityMarkers(const std::vector<mesh::Obstacle>& obstacles);

  /// What there is nothing of is deleted. Valid until the next call.
  /// @param scene with the triangles of the answer and the volumes to be shown
  const visualization_msgs::MarkerArray& update(
      const ProximityScene& scene, const std::vector<proximity::TaperedCapsule>& cursor);

 private:
  void updateElements(const std::vector<proximity::Triangle>& triangles);
  void updateCursor(const std::vector<proximity::TaperedCapsule>& cursor);
  void updateVolumes(const VolumeGroup& group);
  void addGroup(const std::string& name);

  visualization_msgs::MarkerArray markers_;
  std::map<std::string, std::size_t> groups_;  // of volumes, the first of their two markers_
};

}  // namespace haptex::nodes
