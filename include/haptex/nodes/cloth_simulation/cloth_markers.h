// The cloth as rviz markers.
#pragma once

#include <ros/time.h>
#include <visualization_msgs/MarkerArray.h>

#include <Eigen/Core>
#include <array>
#include <vector>

#include "haptex/cloth/forces/membrane.h"
#include "haptex/mesh/mesh.h"
#include "haptex/mesh/obstacle.h"
#include "haptex/simulation/simulated_cloth.h"

namespace haptex::nodes {

/// What the colours of a cloth tell.
enum class ClothColours { kStrain, kFabric };

/// Markers of a cloth in the frame fixedFrame(), in namespaces that rviz can switch off singly:
/// "cloth": triangles coloured by the largest principal Green-Lagrange strain, averaged at the
///   particles with the rest areas of the triangles around. rviz does not light triangles that
///   have colours of their own, so the shading of a fixed light is part of the colours. Particles
///   that are excluded from the computation are grey. Or by the fabric of every triangle
///   (distinctColour()).
/// "scale": the colours of the last four decades to the full scale with numbers in percent, beside
///   the place where the cloth starts; or the names of the fabrics in their colours.
/// "obstacles": those that move; the proximity node shows those that rest.
/// "attachments": attached particles that are not excluded as bars along the edges that join them,
/// or as balls.
class ClothMarkers {
 public:
  /// @param full_scale strain with the last colour of the scale, finite and > 0
  ClothMarkers(const mesh::ClothMesh& mesh, double full_scale,
               const std::vector<mesh::Obstacle>& obstacles = {},
               ClothColours colours = ClothColours::kStrain);

  /// The markers of the present state, valid until the next call. Allocates nothing once the
  /// number of attached particles has been met.
  const visualization_msgs::MarkerArray& update(const simulation::SimulatedCloth& simulation,
                                                const ros::Time& stamp);

 private:
  void addScale();
  void addFabricNames();
  void updateFabricNames(const simulation::SimulatedCloth& simulation);
  void addLabel(const Eigen::Vector3d& place, double height, const std::string& text);
  void computeStrainColours(const simulation::SimulatedCloth& simulation);
  void computeNormals(const std::vector<Eigen::Vector3d>& positions);
  void updateCloth(const simulation::SimulatedCloth& simulation);
  void updateObstacles(const simulation::SimulatedCloth& simulation);
  void updateAttachments(const simulation::SimulatedCloth& simulation);

  std::vector<std::array<int, 3>> triangles_;
  std::vector<std::array<int, 2>> edges_;  // each once
  std::vector<int> triangle_fabrics_;      // empty: all are of the first
  int fabrics_ = 1;
  double full_scale_;
  ClothColours coloured_by_;
  Eigen::Vector3d middle_;  // of the box around the initial positions, m
  Eigen::Vector3d extent_;  // its edges, m
  double size_;             // the longest of them, m

  std::vector<cloth::MembraneElement> elements_;
  std::vector<double> particle_strains_;  // times area, then averaged
  std::vector<double> particle_areas_;    // m^2
  std::vector<Eigen::Vector3d> normals_;  // per particle, unit length
  std::vector<Eigen::Vector3f> colours_;  // per particle
  std::vector<bool> joined_;              // per particle: end of a bar
  std::vector<mesh::Obstacle> moving_;    // obstacles
  std::size_t first_obstacle_ = 0;        // in markers_
  visualization_msgs::MarkerArray markers_;
};

}  // namespace haptex::nodes
