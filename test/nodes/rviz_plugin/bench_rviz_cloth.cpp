// What a state of a cloth of 10 082 triangles costs rviz's thread, by haptex/Cloth and as a marker
// like that of cloth/markers: reading the message from its bytes, and the frame of rviz that takes
// it. Processor time of that thread, ms a state; rendering in software has threads of its own. No
// test: test_rviz_views --gtest_also_run_disabled_tests --gtest_filter=*Cost*
#include <rviz/display.h>
#include <visualization_msgs/MarkerArray.h>

#include <QMetaObject>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <thread>

#include "view_fixture.h"

namespace haptex::nodes::bench_rviz_cloth {
namespace {

constexpr int kStates = 100;

double threadMilliseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

visualization_msgs::MarkerArray markersOf(const haptex::ClothMesh& mesh,
                                          const haptex::ClothState& state) {
  visualization_msgs::MarkerArray array;
  array.markers.resize(1);
  visualization_msgs::Marker& marker = array.markers.front();
  marker.header = state.header;
  marker.type = visualization_msgs::Marker::TRIANGLE_LIST;
  marker.pose.orientation.w = marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
  for (const std::uint32_t particle : mesh.triangles) {
    marker.points.push_back(state.positions[particle]);
    std_msgs::ColorRGBA colour;
    colour.g = colour.a = 1.0F;
    marker.colors.push_back(colour);
  }
  return array;
}

/// Through bytes, as from another process. @param spent ms, on reading
template <typename Message>
boost::shared_ptr<Message> received(const Message& message, double& spent) {
  const ros::SerializedMessage bytes = ros::serialization::serializeMessage(message);
  const double begin = threadMilliseconds();
  const auto copy = boost::make_shared<Message>();
  ros::serialization::IStream stream(bytes.message_start,
                                     static_cast<std::uint32_t>(bytes.num_bytes - 4));
  ros::serialization::deserialize(stream, *copy);
  spent += threadMilliseconds() - begin;
  return copy;
}

TEST_F(ViewTest, DISABLED_CostOfAState) {
  const haptex::ClothMesh mesh = sheetMesh(71, 1000, fabric_file_);
  ros::Publisher markers = node_.advertise<visualization_msgs::MarkerArray>("cloth/markers", 1);
  const auto frame = [this] { QMetaObject::invokeMethod(&manager(), "onUpdate"); };
  double costs[3] = {0.0, 0.0, 0.0};
  for (const int what : {0, 1, 2}) {  // nothing, the display, the marker
    rviz::Display* display = nullptr;
    if (what == 1) display = manager().createDisplay("haptex/Cloth", "Cloth", true);
    if (what == 2) {
      display = manager().createDisplay("rviz/MarkerArray", "Cloth", true);
      display->subProp("Marker Topic")->setValue("cloth/markers");
    }
    publish(mesh, 0.0);
    run(2.0);
    manager().stopUpdate();
    for (int i = 0; i < kStates; ++i) {
      const haptex::ClothState state = sheetState(mesh, 0.01 * i);
      double spent = 0.0;
      if (what == 1) state_publisher_.publish(received(state, spent));
      if (what == 2) markers.publish(received(markersOf(mesh, state), spent));
      std::this_thread::sleep_for(std::chrono::milliseconds(20));  // until it has come
      const double begin = threadMilliseconds();
      frame();
      costs[what] += (spent + threadMilliseconds() - begin) / kStates;
    }
    manager().startUpdate();
    delete display;
  }
  std::printf("ms a state: frame without a cloth %.2f, haptex/Cloth %.2f more, marker %.2f more\n",
              costs[0], costs[1] - costs[0], costs[2] - costs[0]);
}

}  // namespace
}  // namespace haptex::nodes::bench_rviz_cloth
