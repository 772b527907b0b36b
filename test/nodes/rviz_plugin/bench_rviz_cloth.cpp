// What a state of a cloth of 10 082 triangles costs on its way into a picture, by haptex/Cloth and
// by cloth/markers: making the message (the state is made for others, too), writing it into bytes
// and reading it from them, what the frames of rviz that take it cost more than one that draws it
// again, and such a frame. Processor time of the thread, ms, without sockets and without the
// threads that render in software. No test: test_rviz_views --gtest_also_run_disabled_tests
// --gtest_filter=*Cost*
#include <rviz/display.h>
#include <visualization_msgs/MarkerArray.h>

#include <QMetaObject>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <string>
#include <thread>
#include <utility>

#include "../../simulation/small_scene.h"
#include "haptex/nodes/cloth_simulation/cloth_markers.h"
#include "haptex/nodes/common/cloth_messages.h"
#include "view_fixture.h"

namespace haptex::nodes::bench_rviz_cloth {
namespace {

constexpr int kCells = 71;
constexpr int kStates = 100;

/// Of one state or frame, ms.
struct Costs {
  double making = 0.0, writing = 0.0, reading = 0.0, taking = 0.0, drawing = 0.0;
};

template <typename Work>
double millisecondsOf(const Work& work) {
  const auto now = [] {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
  };
  const double begin = now();
  work();
  return now() - begin;
}

simulation::SimulatedCloth sheet() {
  scene::Scene scene = simulation::smallScene();
  scene.mesh = mesh::makeRectangle(0.2, 0.2, kCells, kCells, mesh::Triangulation::kOneWay);
  scene.attached_particles = mesh::sideParticles(scene.mesh, mesh::Side::kTop);
  return simulation::SimulatedCloth(std::move(scene), simulation::smallFabric());
}

class CostOfCloth : public ViewTest {
 protected:
  void frame() { QMetaObject::invokeMethod(&manager(), "onUpdate"); }

  /// Through bytes, as from another process.
  template <typename Message>
  boost::shared_ptr<Message> received(const Message& message, Costs& costs) {
    ros::SerializedMessage bytes;
    costs.writing +=
        millisecondsOf([&] { bytes = ros::serialization::serializeMessage(message); }) / kStates;
    const auto copy = boost::make_shared<Message>();
    costs.reading += millisecondsOf([&] {
                       ros::serialization::IStream stream(
                           bytes.message_start, static_cast<std::uint32_t>(bytes.num_bytes - 4));
                       ros::serialization::deserialize(stream, *copy);
                     }) /
                     kStates;
    return copy;
  }

  /// @param make gives the message of the state after a step, and may be timed
  template <typename Make>
  Costs costsOf(const ros::Publisher& publisher, const Make& make) {
    run(2.0);
    manager().stopUpdate();
    Costs costs;
    for (int i = 0; i < kStates; ++i) {
      simulation_.step();
      publisher.publish(received(make(costs), costs));
      // Markers are drawn by the frame after the one that takes them.
      for (const double count : {1.0, 1.0, -2.0}) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));  // until it has come
        const double spent = millisecondsOf([&] { frame(); }) / kStates;
        costs.taking += count * spent;
        if (count < 0.0) costs.drawing += spent;
      }
    }
    manager().startUpdate();
    return costs;
  }

  Costs costsOfNothing() {
    run(2.0);
    manager().stopUpdate();
    Costs costs;
    for (int i = 0; i < kStates; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      costs.drawing += millisecondsOf([&] { frame(); }) / kStates;
    }
    manager().startUpdate();
    return costs;
  }

  Costs costsOfTheDisplay() {
    rviz::Display* display = manager().createDisplay("haptex/Cloth", "Cloth", true);
    mesh_publisher_.publish(meshMessage(simulation_.cloth(), 1000, {}, ros::Time::now()));
    haptex::ClothState state;
    std::vector<Eigen::Vector3d> forces;
    const Costs costs = costsOf(
        state_publisher_, [&](Costs & /*costs*/) -> auto& {
          simulation_.cloth().computeForces(simulation_.state(), forces);
          fillStateMessage(simulation_, ros::Time::now(), forces, state);
          state.mesh = 1000;
          return state;
        });
    delete display;
    return costs;
  }

  Costs costsOfTheMarkers() {
    rviz::Display* display = manager().createDisplay("rviz/MarkerArray", "Cloth", true);
    display->subProp("Marker Topic")->setValue("cloth/markers");
    ros::Publisher publisher = node_.advertise<visualization_msgs::MarkerArray>("cloth/markers", 1);
    ClothMarkers markers(simulation_.cloth().mesh(), 0.01);
    const Costs costs = costsOf(
        publisher, [&](Costs & spent) -> auto& {
          const visualization_msgs::MarkerArray* array = nullptr;
          spent.making +=
              millisecondsOf([&] { array = &markers.update(simulation_, ros::Time::now()); }) /
              kStates;
          return *array;
        });
    delete display;
    return costs;
  }

  simulation::SimulatedCloth simulation_ = sheet();
};

TEST_F(CostOfCloth, DISABLED_OfAState) {
  const Costs nothing = costsOfNothing();
  Costs display = costsOfTheDisplay();
  Costs markers = costsOfTheMarkers();
  std::printf("ms         making  writing  reading  taking  every state  every frame\n");
  for (auto [name, costs] :
       {std::make_pair("display", display), std::make_pair("markers", markers)}) {
    std::printf("%-9s %7.2f  %7.2f  %7.2f %7.2f  %11.2f  %11.2f\n", name, costs.making,
                costs.writing, costs.reading, costs.taking,
                costs.making + costs.writing + costs.reading + costs.taking,
                costs.drawing - nothing.drawing);
  }
}

/// As many frames as the machine can draw.
TEST_F(CostOfCloth, DISABLED_FramesPerSecond) {
  rviz::Display* display = manager().createDisplay("haptex/Cloth", "Cloth", true);
  const haptex::ClothMesh mesh = sheetMesh(kCells, 1001, fabric_file_);
  publish(mesh, 0.0);
  run(2.0);
  manager().stopUpdate();
  constexpr int kFrames = 300;
  QElapsedTimer timer;
  timer.start();
  for (int i = 0; i < kFrames; ++i) {
    state_publisher_.publish(sheetState(mesh, 0.01 * i));
    frame();
  }
  std::printf("%.0f frames a second, each after a new state\n", 1e3 * kFrames / timer.elapsed());
  manager().startUpdate();
  delete display;
}

}  // namespace
}  // namespace haptex::nodes::bench_rviz_cloth
