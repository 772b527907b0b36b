#include "haptex/nodes/cloth_simulation/cloth_markers.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "haptex/nodes/common/transforms.h"
#include "haptex/nodes/common/vector_messages.h"
#include "haptex/nodes/markers/colour_map.h"
#include "haptex/nodes/markers/marker_shapes.h"
#include "haptex/nodes/markers/obstacle_marker.h"

namespace haptex::nodes {
namespace {

enum MarkerIndex { kClothIndex, kEdgesIndex, kParticlesIndex, kScaleIndex, kFirstLabelIndex };

constexpr int kScaleCells = 64;
const Eigen::Vector3f kExcludedColour(0.62F, 0.62F, 0.62F);

std::vector<std::array<int, 2>> uniqueEdges(const std::vector<std::array<int, 3>>& triangles) {
  std::vector<std::array<int, 2>> edges;
  for (const auto& triangle : triangles) {
    for (int i = 0; i < 3; ++i) {
      const auto [first, second] = std::minmax(triangle[i], triangle[(i + 1) % 3]);
      edges.push_back({first, second});
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

}  // namespace

ClothMarkers::ClothMarkers(const mesh::ClothMesh& mesh, double full_scale,
                           const std::vector<mesh::Obstacle>& obstacles, ClothColours colours)
    : triangles_(mesh.triangles),
      edges_(uniqueEdges(mesh.triangles)),
      triangle_fabrics_(mesh.triangle_fabrics),
      full_scale_(full_scale),
      coloured_by_(colours),
      elements_(cloth::restElements(mesh)) {
  Eigen::Vector3d low = mesh.initial_positions.front();
  Eigen::Vector3d high = low;
  for (const Eigen::Vector3d& position : mesh.initial_positions) {
    low = low.cwiseMin(position);
    high = high.cwiseMax(position);
  }
  middle_ = 0.5 * (low + high);
  extent_ = high - low;
  size_ = extent_.maxCoeff();

  const std::size_t particles = mesh.initial_positions.size();
  particle_strains_.resize(particles);
  particle_areas_.resize(particles);
  normals_.resize(particles);
  colours_.resize(particles);

  using visualization_msgs::Marker;
  auto& markers = markers_.markers;
  markers.push_back(makeMarker("cloth", 0, Marker::TRIANGLE_LIST));
  markers.back().points.resize(3 * triangles_.size());
  markers.back().colors.resize(3 * triangles_.size());
  markers.push_back(makeMarker("attachments", 0, Marker::LINE_LIST));
  markers.back().scale.x = 0.02 * size_;
  markers.push_back(makeMarker("attachments", 1, Marker::SPHERE_LIST));
  markers.back().scale.x = markers.back().scale.y = markers.back().scale.z = 0.025 * size_;
  for (const int index : {kEdgesIndex, kParticlesIndex}) {
    markers[index].color = colourMessage(Eigen::Vector3f(0.25F, 0.27F, 0.30F));
  }
  for (const int fabric : triangle_fabrics_) fabrics_ = std::max(fabrics_, fabric + 1);
  if (coloured_by_ == ClothColours::kStrain) {
    addScale();
  } else {
    addFabricNames();
  }
  first_obstacle_ = markers.size();
  for (const mesh::Obstacle& obstacle : obstacles) {
    if (!obstacle.moves()) continue;
    markers.push_back(obstacleMarker(obstacle, static_cast<int>(moving_.size())));
    moving_.push_back(obstacle);
  }
}

void ClothMarkers::updateObstacles(const simulation::SimulatedCloth& simulation) {
  std::size_t bodies = 0;
  for (std::size_t i = 0; i < moving_.size(); ++i) {
    markers_.markers[first_obstacle_ + i].pose =
        poseMessage(moving_[i].body ? simulation.bodies()[bodies++].pose()
                                    : moving_[i].poseAt(simulation.state().time));
  }
}

const visualization_msgs::MarkerArray& ClothMarkers::updateMovingObstacles(
    const simulation::SimulatedCloth& simulation, const ros::Time& stamp) {
  updateObstacles(simulation);
  obstacle_markers_.markers.assign(
      markers_.markers.begin() + static_cast<std::ptrdiff_t>(first_obstacle_),
      markers_.markers.end());
  for (visualization_msgs::Marker& marker : obstacle_markers_.markers) marker.header.stamp = stamp;
  return obstacle_markers_;
}

void ClothMarkers::addScale() {
  markers_.markers.push_back(makeMarker("scale", 0, visualization_msgs::Marker::TRIANGLE_LIST));
  const double height = 0.7 * size_;
  const Eigen::Vector3d bottom =
      middle_ + Eigen::Vector3d(0.0, 0.5 * extent_.y() + 0.14 * size_, -0.5 * height);
  const Eigen::Vector3d across(0.0, 0.05 * size_, 0.0);
  const auto at = [&](double fraction) {
    return Eigen::Vector3d(bottom + Eigen::Vector3d(0.0, 0.0, fraction * height));
  };
  visualization_msgs::Marker& bar = markers_.markers.back();
  for (int cell = 0; cell < kScaleCells; ++cell) {
    const double begin = static_cast<double>(cell) / kScaleCells;
    const double end = static_cast<double>(cell + 1) / kScaleCells;
    const std::array<Eigen::Vector3d, 4> corners = {at(begin), at(begin) + across, at(end) + across,
                                                    at(end)};
    for (const int corner : {0, 1, 2, 0, 2, 3}) {
      bar.points.push_back(pointMessage(corners[corner]));
      bar.colors.push_back(colourMessage(viridis(corner < 2 ? begin : end)));
    }
  }
  for (int decade = 0; decade <= kStrainDecades; ++decade) {
    const double strain = full_scale_ * std::pow(10.0, decade - kStrainDecades);
    char text[32];
    std::snprintf(text, sizeof(text), "%.3g%%", 100.0 * strain);
    addLabel(at(strainFraction(strain, full_scale_)) + Eigen::Vector3d(0.0, 0.15 * size_, 0.0),
             0.04 * size_, text);
  }
  addLabel(at(1.0) + Eigen::Vector3d(0.0, 0.07 * size_, 0.08 * size_), 0.045 * size_, "strain");
}

/// Beside the place where the cloth starts, from the top down.
void ClothMarkers::addFabricNames() {
  for (int fabric = 0; fabric < fabrics_; ++fabric) {
    const Eigen::Vector3d place = middle_ + Eigen::Vector3d(0.0, 0.5 * extent_.y() + 0.3 * size_,
                                                            0.4 * size_ - 0.08 * size_ * fabric);
    addLabel(place, 0.05 * size_, "");
    markers_.markers.back().color = colourMessage(distinctColour(fabric));
  }
}

/// They may get others while the node runs.
void ClothMarkers::updateFabricNames(const simulation::SimulatedCloth& simulation) {
  for (int fabric = 0; fabric < fabrics_; ++fabric) {
    markers_.markers[kScaleIndex + fabric].text = simulation.cloth().fabrics()[fabric].name;
  }
}

void ClothMarkers::addLabel(const Eigen::Vector3d& place, double height, const std::string& text) {
  const int id = static_cast<int>(markers_.markers.size());
  markers_.markers.push_back(makeMarker("scale", id, visualization_msgs::Marker::TEXT_VIEW_FACING));
  visualization_msgs::Marker& label = markers_.markers.back();
  label.pose.position = pointMessage(place);
  label.scale.z = height;
  label.color = colourMessage(Eigen::Vector3f(0.1F, 0.1F, 0.1F));
  label.text = text;
}

const visualization_msgs::MarkerArray& ClothMarkers::update(
    const simulation::SimulatedCloth& simulation, const ros::Time& stamp) {
  if (coloured_by_ == ClothColours::kStrain) {
    computeStrainColours(simulation);
  } else {
    updateFabricNames(simulation);
  }
  computeNormals(simulation.state().positions);
  updateCloth(simulation);
  updateAttachments(simulation);
  updateObstacles(simulation);
  for (visualization_msgs::Marker& marker : markers_.markers) marker.header.stamp = stamp;
  return markers_;
}

void ClothMarkers::computeStrainColours(const simulation::SimulatedCloth& simulation) {
  std::fill(particle_strains_.begin(), particle_strains_.end(), 0.0);
  std::fill(particle_areas_.begin(), particle_areas_.end(), 0.0);
  for (const cloth::MembraneElement& element : elements_) {
    const double strain =
        largestPrincipalStrain(cloth::greenStrain(element, simulation.state().positions));
    for (const int particle : element.particles) {
      particle_strains_[particle] += element.area * strain;
      particle_areas_[particle] += element.area;
    }
  }
  const std::vector<char>& excluded = simulation.excluded();
  for (std::size_t i = 0; i < colours_.size(); ++i) {
    if (!excluded.empty() && excluded[i] != 0) {
      colours_[i] = kExcludedColour;
      continue;
    }
    const double strain = particle_strains_[i] / particle_areas_[i];
    colours_[i] = viridis(strainFraction(strain, full_scale_));
  }
}

void ClothMarkers::computeNormals(const std::vector<Eigen::Vector3d>& positions) {
  std::fill(normals_.begin(), normals_.end(), Eigen::Vector3d::Zero());
  for (const auto& triangle : triangles_) {
    const Eigen::Vector3d& first = positions[triangle[0]];
    const Eigen::Vector3d normal =
        (positions[triangle[1]] - first).cross(positions[triangle[2]] - first);
    for (const int particle : triangle) normals_[particle] += normal;
  }
  for (Eigen::Vector3d& normal : normals_) normal.normalize();
}

void ClothMarkers::updateCloth(const simulation::SimulatedCloth& simulation) {
  const std::vector<Eigen::Vector3d>& positions = simulation.state().positions;
  const bool by_strain = coloured_by_ == ClothColours::kStrain;
  for (std::size_t i = 0; i < colours_.size() && by_strain; ++i) {
    colours_[i] *= shade(normals_[i]);
  }
  visualization_msgs::Marker& marker = markers_.markers[kClothIndex];
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    const int fabric = triangle_fabrics_.empty() ? 0 : triangle_fabrics_[i];
    const Eigen::Vector3f of_fabric = distinctColour(fabric);
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const int particle = triangles_[i][corner];
      marker.points[3 * i + corner] = pointMessage(positions[particle]);
      marker.colors[3 * i + corner] = colourMessage(
          by_strain ? colours_[particle] : Eigen::Vector3f(of_fabric * shade(normals_[particle])));
    }
  }
}

void ClothMarkers::updateAttachments(const simulation::SimulatedCloth& simulation) {
  using visualization_msgs::Marker;
  const std::vector<Eigen::Vector3d>& positions = simulation.state().positions;
  const std::vector<char>& excluded = simulation.excluded();
  const auto held = [&, &attachments = simulation.cloth().attachments()](std::size_t particle) {
    return attachments[particle] && (excluded.empty() || excluded[particle] == 0);
  };
  Marker& bars = markers_.markers[kEdgesIndex];
  bars.points.clear();
  joined_.assign(positions.size(), false);
  for (const auto& [first, second] : edges_) {
    if (!held(first) || !held(second)) continue;
    bars.points.push_back(pointMessage(positions[first]));
    bars.points.push_back(pointMessage(positions[second]));
    joined_[first] = joined_[second] = true;
  }
  Marker& particles = markers_.markers[kParticlesIndex];
  particles.points.clear();
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (held(i) && !joined_[i]) particles.points.push_back(pointMessage(positions[i]));
  }
  deleteIfEmpty(bars);
  deleteIfEmpty(particles);
}

}  // namespace haptex::nodes
