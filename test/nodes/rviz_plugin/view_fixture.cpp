#include "view_fixture.h"

#include <rviz/config.h>
#include <rviz/display.h>
#include <rviz/display_group.h>
#include <rviz/yaml_config_reader.h>

#include <chrono>
#include <fstream>
#include <iterator>
#include <thread>

namespace haptex::nodes {

std::string linearFabricFile() {
  std::ifstream file(HAPTEX_CONFIG_DIRECTORY "/fabrics/linear.yaml");
  return {std::istreambuf_iterator<char>(file), {}};
}

rviz::VisualizationFrame* ViewTest::frame_ = nullptr;

void ViewTest::closeWindow() {
  delete frame_;
  frame_ = nullptr;
}

void ViewTest::SetUp() {
  if (frame_ == nullptr) {
    frame_ = new rviz::VisualizationFrame;
    frame_->setSplashPath("");
    frame_->initialize(HAPTEX_SOURCE_DIRECTORY "/test/nodes/rviz_plugin/empty.rviz");
    frame_->show();
  }
  mesh_publisher_ = node_.advertise<haptex::ClothMesh>("cloth/mesh", 1, true);
  state_publisher_ = node_.advertise<haptex::ClothState>("cloth/state", 1, true);
  contact_publisher_ = node_.advertise<haptex::Contact>("index/contact", 1, true);
  static tf2_ros::StaticTransformBroadcaster broadcaster;
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = ros::Time::now();
  transform.header.frame_id = "world";
  transform.child_frame_id = "hand_base";
  transform.transform.rotation.w = 1.0;
  broadcaster.sendTransform(transform);
}

void ViewTest::TearDown() { load("Panels: []\nVisualization Manager:\n  Displays: []\n"); }

bool ViewTest::run(double seconds, const std::function<bool()>& until) {
  QElapsedTimer timer;
  timer.start();
  while (timer.elapsed() < 1e3 * seconds) {
    QApplication::processEvents(QEventLoop::AllEvents);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    if (until()) return true;
  }
  return until();
}

void ViewTest::publish(const haptex::ClothMesh& mesh, double time) {
  mesh_publisher_.publish(mesh);
  state_publisher_.publish(sheetState(mesh, time));
  haptex::Contact contact;
  contact.header.frame_id = "world";
  contact.touching = 1;
  contact.force.x = 0.3;
  contact_publisher_.publish(contact);
}

void ViewTest::load(const std::string& yaml) {
  rviz::YamlConfigReader reader;
  rviz::Config config;
  reader.readString(config, QString::fromStdString(yaml));
  frame_->load(config);
}

}  // namespace haptex::nodes
