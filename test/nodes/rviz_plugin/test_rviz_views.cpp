// What people do to a view of rviz, and what may go wrong around it: nothing of it ends rviz. Run
// by rviz_views_test.py, with a display.
#include <OGRE/OgreRenderWindow.h>
#include <rviz/display.h>
#include <rviz/display_group.h>
#include <rviz/properties/enum_property.h>
#include <rviz/properties/status_property.h>
#include <rviz/render_panel.h>
#include <std_msgs/Header.h>
#include <std_srvs/Trigger.h>

#include <QDockWidget>
#include <QLabel>
#include <QPushButton>
#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <future>
#include <limits>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "../../appearance/fixtures.h"
#include "../../temporary_directory.h"
#include "haptex/appearance/btf_file.h"
#include "timed_application.h"
#include "view_fixture.h"

namespace haptex::nodes::test_rviz_views {
namespace {

constexpr int kCycles = 1000;

/// Whether a display says that something of this name is well.
bool isWell(rviz::Display* display, const QString& name) {
  for (int i = 0; i < display->numChildren(); ++i) {
    rviz::Property* list = display->childAt(i);
    for (int j = 0; j < list->numChildren(); ++j) {
      const auto* status = qobject_cast<rviz::StatusProperty*>(list->childAt(j));
      if (status != nullptr && status->getName() == name) {
        return status->getLevel() == rviz::StatusProperty::Ok;
      }
    }
  }
  return false;
}

TEST_F(ViewTest, DisplaysAreAddedAndRemovedOverAndOver) {
  const haptex::ClothMesh mesh = sheetMesh(16, 1, fabric_file_);
  publish(mesh, 0.0);
  for (int cycle = 0; cycle < kCycles; ++cycle) {
    rviz::Display* cloth = manager().createDisplay("haptex/Cloth", "Cloth", true);
    rviz::Display* contact = manager().createDisplay("haptex/Contact", "Contact", true);
    ASSERT_NE(cloth, nullptr);
    if (cycle % 10 == 0) {
      EXPECT_TRUE(run(10.0, [&] { return isWell(cloth, "State"); })) << "the cloth is not drawn";
    } else {
      run(0.01 * (cycle % 3));
    }
    state_publisher_.publish(sheetState(mesh, 0.01 * cycle));
    delete cloth;
    delete contact;
  }
  EXPECT_EQ(manager().getRootDisplayGroup()->numDisplays(), 0);
}

TEST_F(ViewTest, DisplaysAreSwitchedOffAndOnAndReset) {
  const haptex::ClothMesh mesh = sheetMesh(16, 2, fabric_file_);
  publish(mesh, 0.0);
  rviz::Display* cloth = manager().createDisplay("haptex/Cloth", "Cloth", true);
  for (int cycle = 0; cycle < kCycles; ++cycle) {
    cloth->setEnabled(false);
    run(0.01 * (cycle % 2));
    cloth->setEnabled(true);
    if (cycle % 3 == 0) cloth->reset();
    run(0.01);
  }
  EXPECT_TRUE(run(10.0, [&] { return isWell(cloth, "State"); }));
}

TEST_F(ViewTest, ATopicThatIsThereAsAnotherTypeIsLeftOut) {
  ros::NodeHandle node;
  const boost::function<void(const std_msgs::HeaderConstPtr&)> nothing =
      [](const std_msgs::HeaderConstPtr& /*message*/) {};
  const ros::Subscriber other = node.subscribe<std_msgs::Header>("/elsewhere/mesh", 1, nothing);
  const haptex::ClothMesh mesh = sheetMesh(16, 4, fabric_file_);
  publish(mesh, 0.0);
  rviz::Display* cloth = manager().createDisplay("haptex/Cloth", "Cloth", true);
  const QVariant topics = cloth->subProp("Topics")->getValue();
  cloth->subProp("Topics")->setValue("/elsewhere");
  run(1.0);
  cloth->subProp("Topics")->setValue(topics);
  EXPECT_TRUE(run(10.0, [&] { return isWell(cloth, "State"); }));
}

TEST_F(ViewTest, ThePanelIsAddedAndRemovedOverAndOver) {
  for (int cycle = 0; cycle < kCycles; ++cycle) {
    QDockWidget* dock = frame_->addPanelByName("haptex", "haptex/Panel");
    ASSERT_NE(dock, nullptr);
    run(cycle % 10 == 0 ? 0.15 : 0.0);
    delete dock;
  }
}

TEST_F(ViewTest, EveryColourAndStyleIsDrawn) {
  const haptex::ClothMesh mesh = sheetMesh(16, 3, fabric_file_);
  publish(mesh, 0.0);
  rviz::Display* cloth = manager().createDisplay("haptex/Cloth", "Cloth", true);
  for (const char* colours : {"Strain", "Stress", "Contact force", "Fabric", "Panel", "Look"}) {
    for (const bool on : {true, false}) {
      cloth->subProp("Colour by")->setValue(colours);
      cloth->subProp("Wireframe")->setValue(on);
      cloth->subProp("Grain lines")->setValue(on);
      cloth->subProp("Self-shadow")->setValue(on);
      cloth->subProp("Legend")->setValue(on);
      cloth->subProp("Alpha")->setValue(on ? 0.5F : 1.0F);
      cloth->subProp("Full scale")->setValue(on ? 0.5F : 0.0F);
      state_publisher_.publish(sheetState(mesh, 0.1));
      run(0.1);  // a few frames
      EXPECT_TRUE(run(10.0, [&] { return isWell(cloth, "State"); })) << colours;
    }
  }
}

TEST_F(ViewTest, ALookIsReadWhileTheClothIsDrawn) {
  const test::TemporaryDirectory folder;
  const material::Look look{{0.5}, {0.5}, 0.0, 1.0};
  appearance::writeBtf(appearance::makeBtf(appearance::flatRelief(), look, {16, 16, {4, 1, 4}}),
                       folder.path() + "/linear.btf");
  publish(sheetMesh(16, 5, fabric_file_), 0.0);
  rviz::Display* cloth = manager().createDisplay("haptex/Cloth", "Cloth", true);
  cloth->subProp("Colour by")->setValue("Look");
  EXPECT_TRUE(run(10.0, [&] { return isWell(cloth, "State"); }));
  EXPECT_FALSE(isWell(cloth, "Look")) << "no folder is given";
  cloth->subProp("BTF folder")->setValue(QString::fromStdString(folder.path()));
  EXPECT_TRUE(run(20.0, [&] { return isWell(cloth, "Look") && isWell(cloth, "State"); }));
}

/// Pixels of the view that are red, as arrows of forces are.
int redPixels(rviz::VisualizationManager& manager) {
  Ogre::RenderWindow* window = manager.getRenderPanel()->getRenderWindow();
  const auto width = window->getWidth(), height = window->getHeight();
  std::vector<std::uint8_t> bytes(std::size_t{3} * width * height);
  window->copyContentsToMemory(Ogre::Box(0, 0, width, height),
                               Ogre::PixelBox(width, height, 1, Ogre::PF_BYTE_RGB, bytes.data()));
  int count = 0;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    count += bytes[i] > 80 && bytes[i] > 2 * bytes[i + 1] && bytes[i] > 2 * bytes[i + 2] ? 1 : 0;
  }
  return count;
}

TEST_F(ViewTest, AForceOfTenMillinewtonsIsSeen) {
  rviz::Display* display = manager().createDisplay("haptex/Contact", "Contact", true);
  haptex::Contact contact;
  contact.header.frame_id = "world";
  contact_publisher_.publish(contact);
  run(1.0);
  EXPECT_EQ(redPixels(manager()), 0);
  contact.touching = 1;
  contact.force.z = 0.01;
  bool seen = false;
  for (int i = 0; i < 50 && !seen; ++i) {  // queues of one message may lose it
    contact_publisher_.publish(contact);
    seen = run(0.2, [&] { return redPixels(manager()) > 0; });
  }
  // 9 mm are 8 pixels in a view as small as this one.
  EXPECT_GE(redPixels(manager()), 20);
  delete display;
}

TEST_F(ViewTest, MeshesAndFabricsChangeWhileTheyAreDrawn) {
  rviz::Display* cloth = manager().createDisplay("haptex/Cloth", "Cloth", true);
  for (int i = 0; i < 200; ++i) {
    publish(sheetMesh(4 + i % 20, static_cast<std::uint32_t>(100 + i), fabric_file_), 0.01 * i);
    run(0.005);
  }
  EXPECT_TRUE(run(10.0, [&] { return isWell(cloth, "State"); }));
}

TEST_F(ViewTest, MessagesThatAreWrongAreRefusedAndTheNextIsDrawn) {
  rviz::Display* cloth = manager().createDisplay("haptex/Cloth", "Cloth", true);
  const haptex::ClothMesh good = sheetMesh(8, 500, fabric_file_);
  haptex::ClothMesh outside = good;
  outside.triangles[0] = 1000000;
  haptex::ClothMesh empty;
  haptex::ClothMesh nan = good;
  nan.rest_weft_coordinates[0] = std::numeric_limits<double>::quiet_NaN();
  for (const haptex::ClothMesh& bad : {outside, empty, nan}) {
    publish(good, 0.0);
    EXPECT_TRUE(run(10.0, [&] { return isWell(cloth, "Mesh"); }));
    mesh_publisher_.publish(bad);
    EXPECT_TRUE(run(10.0, [&] { return !isWell(cloth, "Mesh"); }));
  }
  haptex::ClothState state = sheetState(good, 0.0);
  publish(good, 0.0);
  EXPECT_TRUE(run(10.0, [&] { return isWell(cloth, "State"); }));
  state.positions[5].x = std::numeric_limits<double>::infinity();
  // Queues of one message may lose it: again until it has come.
  bool refused = false;
  for (int i = 0; i < 50 && !refused; ++i) {
    state_publisher_.publish(state);
    refused = run(0.2, [&] { return !isWell(cloth, "State"); });
  }
  EXPECT_TRUE(refused);
  state_publisher_.publish(sheetState(good, 0.1));
  EXPECT_TRUE(run(10.0, [&] { return isWell(cloth, "State"); }));
}

TEST_F(ViewTest, BrokenConfigurationsAreTakenAsFarAsTheyCanBe) {
  const std::string before =
      "Visualization Manager:\n  Displays:\n    - Class: haptex/Cloth\n"
      "      Name: Cloth\n      Enabled: true\n";
  for (const char* lines :
       {"      Colour by: Temperature\n", "      Colour by: 7\n", "      Colour by: [1, 2]\n",
        "      Full scale: -3\n", "      Full scale: .nan\n", "      Full scale: much\n",
        "      Alpha: 1e9\n", "      Topics: \"\"\n", "      Topics: \"no name!\"\n",
        "      Topics: {a: b}\n", "      Wireframe: perhaps\n", "      Unknown: 1\n", ""}) {
    load(before + lines);
    run(0.05);
    EXPECT_EQ(manager().getRootDisplayGroup()->numDisplays(), 1) << lines;
  }
}

TEST_F(ViewTest, ConfigurationsFromBeforeTheDisplaysAreTaken) {
  load(
      "Panels: []\nVisualization Manager:\n  Displays:\n    - Class: rviz/MarkerArray\n"
      "      Name: Cloth\n      Enabled: true\n      Marker Topic: cloth/markers\n"
      "    - Class: haptex/Removed\n      Name: Of another version\n      Enabled: true\n");
  run(0.1);
  EXPECT_EQ(manager().getRootDisplayGroup()->numDisplays(), 2);
  for (const char* name : {"cloth", "exoskeleton", "garment", "haptex"}) {
    frame_->loadDisplayConfigHelper(std::string(HAPTEX_SOURCE_DIRECTORY "/rviz/") + name + ".rviz",
                                    true);
    run(0.2);
  }
}

TimedApplication& application() { return *dynamic_cast<TimedApplication*>(qApp); }

/// One line, of what happened since the last one: what was done to the window, its events, most of
/// which are frames that rviz draws, and those of the panel.
void printLongest(const std::string& when, const TimeSpent& action) {
  std::printf("%s:", when.c_str());
  for (const auto& [kind, time] :
       {std::make_pair("action", action), std::make_pair("event", application().ofWindow()),
        std::make_pair("event of the panel", application().ofPanel())}) {
    if (time.what.empty()) continue;
    std::printf(" %s %.1f ms = %.1f computing + %.1f queued + %.1f waiting (%s);", kind,
                time.lasted, time.computed, time.queued, time.waited(), time.what.c_str());
  }
  std::printf("\n");
  application().forget();
}

TEST_F(ViewTest, AServiceThatHangsDoesNotKeepThePanel) {
  std::atomic<bool> release{false}, called{false};
  ros::CallbackQueue queue;
  ros::NodeHandle node;
  node.setCallbackQueue(&queue);
  const boost::function<bool(std_srvs::Trigger::Request&, std_srvs::Trigger::Response&)> hang =
      [&](std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
        called = true;
        while (!release) std::this_thread::sleep_for(std::chrono::milliseconds(5));
        response.success = true;
        response.message = "done at last";
        return true;
      };
  ros::ServiceServer service = node.advertiseService("cloth/reset", hang);
  ros::AsyncSpinner spinner(1, &queue);
  spinner.start();
  run(1.0);  // rviz's first frames
  application().forget();
  run(3.0);
  printLongest("rviz alone", {});
  QDockWidget* dock = frame_->addPanelByName("haptex", "haptex/Panel");
  QPushButton* reset = nullptr;
  for (QPushButton* button : dock->findChildren<QPushButton*>()) {
    if (button->text() == "Reset") reset = button;
  }
  ASSERT_NE(reset, nullptr);
  auto* answer = dock->findChild<QLabel*>("answer");
  ASSERT_NE(answer, nullptr);
  const Stopwatch click;
  reset->click();
  const TimeSpent first_click = click.read("the button");
  EXPECT_TRUE(run(10.0, [&] { return called.load(); }));
  // All of this while the service hangs.
  EXPECT_TRUE(run(10.0, [&] { return answer->text() == "no answer yet from cloth/reset"; }));
  reset->click();
  EXPECT_EQ(answer->text(), "cloth/reset: the call before has not been answered yet");
  release = true;
  EXPECT_TRUE(run(10.0, [&] { return answer->text() == "cloth/reset: done at last"; }));
  // One that is not there.
  service.shutdown();
  reset->click();
  EXPECT_TRUE(run(10.0, [&] { return answer->text().contains("does not answer"); }))
      << answer->text().toStdString();
  printLongest("a service that hangs or is gone", first_click);
}

using Action = std::pair<const char*, std::function<void()>>;

/// Only beside a bag that is replayed by a node that HAPTEX_PLAYER names, once.
TEST_F(ViewTest, AReplayedBagIsSaidByThePanel) {
  const char* player = std::getenv("HAPTEX_PLAYER");
  if (player == nullptr) GTEST_SKIP() << "nothing is replayed";
  const QString begin =
      QString("A bag is replayed by %1, and no node answers the buttons. ").arg(player);
  QDockWidget* dock = frame_->addPanelByName("haptex", "haptex/Panel");
  auto* line = dock->findChild<QLabel*>("line");
  ASSERT_NE(line, nullptr);
  const auto said = [&] { return line->text().toStdString(); };
  EXPECT_TRUE(run(20.0, [&] { return line->text().startsWith(begin + "It recorded: the index"); }))
      << said();
  std::printf("beside a replayed bag: %s\n", said().c_str());
  // And all the time, also when it has ended.
  EXPECT_FALSE(run(3.0, [&] { return !line->text().startsWith(begin); })) << said();
  EXPECT_TRUE(run(60.0, [&] { return line->text().contains("Nothing has come for"); })) << said();
  EXPECT_TRUE(line->text().startsWith(begin)) << said();
}

/// What is done with panel and display by a person.
TimeSpent longestOf(const std::function<void(double)>& run, const std::vector<Action>& actions) {
  TimeSpent longest;
  for (const auto& [name, action] : actions) {
    const Stopwatch watch;
    action();
    const TimeSpent spent = watch.read(name);
    if (spent.lasted > longest.lasted) longest = spent;
    run(0.1);
  }
  return longest;
}

/// Whether somebody else in this process, like one of rviz's own displays, who subscribes is
/// answered by roscpp within a while.
bool subscribesToNothing(ros::NodeHandle node) {
  std::promise<void> promise;
  std::future<void> done = promise.get_future();
  std::thread([node, promise = std::move(promise)]() mutable {
    const ros::Subscriber subscriber = node.subscribe<haptex::ClothMesh>(
        "nothing", 1, boost::function<void(const haptex::ClothMeshConstPtr&)>());
    promise.set_value();
  }).detach();
  return done.wait_for(std::chrono::seconds(20)) == std::future_status::ready;
}

/// Only with a master of its own, whose process HAPTEX_MASTER names.
TEST_F(ViewTest, AMasterThatHangsOrDiesKeepsNothing) {
  const char* master = std::getenv("HAPTEX_MASTER");
  if (master == nullptr) GTEST_SKIP() << "the master is not ours";
  const pid_t process = std::atoi(master);
  const haptex::ClothMesh mesh = sheetMesh(16, 900, fabric_file_);
  publish(mesh, 0.0);
  for (const char* what : {"lives", "hangs", "is dead"}) {
    if (std::string(what) == "hangs") kill(process, SIGSTOP);
    if (std::string(what) == "is dead") kill(process, SIGKILL);
    QDockWidget* dock = nullptr;
    rviz::Display* cloth = nullptr;
    const auto handle = [this](double seconds) { run(seconds); };
    application().forget();
    const auto click = [&dock] {
      for (auto* button : dock->findChildren<QPushButton*>()) button->click();
    };
    TimeSpent longest;
    for (int cycle = 0; cycle < 5; ++cycle) {
      const TimeSpent spent = longestOf(
          handle,
          {{"adding the panel", [&] { dock = frame_->addPanelByName("haptex", "haptex/Panel"); }},
           {"adding the display",
            [&] { cloth = manager().createDisplay("haptex/Cloth", "Cloth", true); }},
           {"every button", click},
           {"resetting the display", [&] { cloth->reset(); }},
           {"a frame of the display", [&] { cloth->update(0.03F, 0.03F); }},
           {"removing the display", [&] { delete cloth; }},
           {"removing the panel", [&] { delete dock; }}});
      if (spent.lasted > longest.lasted) longest = spent;
    }
    printLongest(std::string("a master that ") + what, longest);
  }
  EXPECT_TRUE(subscribesToNothing(node_)) << "who subscribes now holds roscpp's lock for ever";
}

}  // namespace
}  // namespace haptex::nodes::test_rviz_views

int main(int argc, char** argv) {
  ros::init(argc, argv, "test_rviz_views", ros::init_options::AnonymousName);
  testing::InitGoogleTest(&argc, argv);
  haptex::nodes::TimedApplication application(argc, argv);
  const ros::NodeHandle node;  // roscpp runs as long as it is there
  const int result = RUN_ALL_TESTS();
  haptex::nodes::ViewTest::closeWindow();
  return result;
}
