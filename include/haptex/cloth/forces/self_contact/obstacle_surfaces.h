// The surfaces of a scene's obstacles, as contact of the cloth with itself sees them.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <string>
#include <vector>

#include "haptex/mesh/obstacle.h"
#include "haptex/proximity/element_pair.h"

namespace haptex::cloth {

/// All obstacles as one surface of vertices, edges and triangles, each with a radius within which
/// it is solid: a sphere is one vertex, which a triangle without area stands for, a capsule one
/// edge, a box twelve triangles and a mesh its own ones, both without radius. World frame.
///
/// During a step vertices go in straight lines from where they are at its beginning to where they
/// are at its end; so what turns by a large angle within a step cuts the corner.
class ObstacleSurfaces {
 public:
  /// At time 0.
  /// @param obstacles sound, at least one
  explicit ObstacleSurfaces(std::vector<mesh::Obstacle> obstacles);

  /// Another step. It begins where the last one has ended, if it does so at that time; where it was
  /// repeated, if at the time at which that began; and else where the poses say.
  /// @param begin, end s, simulated
  /// @return whether it goes on from the last one's beginning or end
  bool move(double begin, double end);
  /// At the end of the step the vertices are somewhere else, because something was in their way.
  void stopAt(const std::vector<Eigen::Vector3d>& places);

  const proximity::MeshElements& elements() const { return elements_; }
  std::size_t vertexCount() const { return obstacle_of_.size(); }
  /// m, of the vertices.
  const std::vector<Eigen::Vector3d>& atBegin() const { return begin_; }
  const std::vector<Eigen::Vector3d>& atEnd() const { return end_; }
  /// Those that belong to a time (s): at the beginning of the step up to then, and after it at the
  /// end.
  bool isEnd(double time) const { return time > begin_time_; }
  const std::vector<Eigen::Vector3d>& at(double time) const { return isEnd(time) ? end_ : begin_; }
  double timeStep() const { return end_time_ - begin_time_; }  ///< s
  bool moved() const { return moved_; }                        ///< in this step
  /// Another number whenever places have changed.
  int revision() const { return revision_; }

  int obstacleOf(int vertex) const { return obstacle_of_[vertex]; }
  int count() const { return static_cast<int>(obstacles_.size()); }
  const mesh::Obstacle& obstacle(int index) const { return obstacles_[index]; }
  double radius(int obstacle) const { return radius_[obstacle]; }  ///< m, >= 0

  /// How far (m) a point of the surface goes in the step.
  /// @param vertices, weights its nearest point of the elements; `count` of them
  /// @param offset m, from there to the surface, at the end of the step or else at its beginning
  Eigen::Vector3d wayOf(int obstacle, int count, const int* vertices, const double* weights,
                        const Eigen::Vector3d& offset, bool at_end) const;

 private:
  void place(double time, std::vector<Eigen::Vector3d>& places) const;

  std::vector<mesh::Obstacle> obstacles_;
  std::vector<Eigen::Vector3d> own_;  // m, vertices in the frames of their obstacles
  std::vector<int> obstacle_of_;      // of a vertex
  std::vector<double> radius_;        // m, of an obstacle
  proximity::MeshElements elements_;
  std::vector<Eigen::Vector3d> begin_, end_;  // m
  std::vector<Eigen::Matrix3d> turn_;         // of an obstacle, from the end to the beginning
  double begin_time_ = 0.0, end_time_ = 0.0;  // s
  bool moved_ = false;
  int revision_ = 0;
};

}  // namespace haptex::cloth
