// A window of rviz and a cloth for it, without any node of ours.
#pragma once

#include <gtest/gtest.h>
#include <haptex/ClothMesh.h>
#include <haptex/ClothState.h>
#include <haptex/Contact.h>
#include <ros/ros.h>
#include <rviz/visualization_frame.h>
#include <rviz/visualization_manager.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include <QApplication>
#include <QElapsedTimer>
#include <cmath>
#include <functional>
#include <memory>
#include <string>

namespace haptex::nodes {

/// A square of `cells` x `cells`, of linear fabric.
inline haptex::ClothMesh sheetMesh(int cells, std::uint32_t number,
                                   const std::string& fabric_file) {
  haptex::ClothMesh mesh;
  mesh.header.frame_id = "world";
  mesh.mesh = number;
  mesh.fabrics = {"linear"};
  mesh.fabric_files = {fabric_file};
  for (int row = 0; row <= cells; ++row) {
    for (int column = 0; column <= cells; ++column) {
      mesh.rest_weft_coordinates.push_back(0.2 * column / cells);
      mesh.rest_warp_coordinates.push_back(0.2 * row / cells);
    }
  }
  for (int row = 0; row < cells; ++row) {
    for (int column = 0; column < cells; ++column) {
      const auto at = static_cast<std::uint32_t>(row * (cells + 1) + column);
      const auto above = at + static_cast<std::uint32_t>(cells) + 1;
      for (const std::uint32_t corner : {at, at + 1, above, at + 1, above + 1, above}) {
        mesh.triangles.push_back(corner);
      }
    }
  }
  return mesh;
}

/// Waves that travel. @param time s
inline haptex::ClothState sheetState(const haptex::ClothMesh& mesh, double time) {
  haptex::ClothState state;
  state.header.frame_id = "world";
  state.mesh = mesh.mesh;
  state.simulated_time = time;
  for (std::size_t i = 0; i < mesh.rest_weft_coordinates.size(); ++i) {
    geometry_msgs::Point point;
    point.y = mesh.rest_weft_coordinates[i] - 0.1;
    point.z = mesh.rest_warp_coordinates[i] - 0.2;
    point.x = 0.01 * std::sin(60.0 * point.z + 5.0 * time);
    state.positions.push_back(point);
  }
  state.attached = {0};
  return state;
}

std::string linearFabricFile();

/// rviz's window, whose events are handled in run(). There is one for all tests: rviz makes its
/// materials once per process.
class ViewTest : public ::testing::Test {
 public:
  /// At the end of all tests.
  static void closeWindow();

 protected:
  void SetUp() override;
  void TearDown() override;

  /// Handles events for so long (s), or until something is so. @returns whether it was
  bool run(
      double seconds, const std::function<bool()>& until = [] { return false; });
  /// Publishes mesh and state.
  void publish(const haptex::ClothMesh& mesh, double time);
  /// The window takes a configuration, as from a file. @param yaml of displays
  void load(const std::string& yaml);

  rviz::VisualizationManager& manager() { return *frame_->getManager(); }

  ros::NodeHandle node_;
  static rviz::VisualizationFrame* frame_;
  ros::Publisher mesh_publisher_, state_publisher_, contact_publisher_;
  std::string fabric_file_ = linearFabricFile();
};

}  // namespace haptex::nodes
