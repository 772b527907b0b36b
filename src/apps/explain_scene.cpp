// The program explain_scene: what a scene models, at what cost and error. Needs no ROS master.
#include <exception>
#include <iostream>
#include <string>

#include "haptex/nodes/common/config_files.h"
#include "haptex/scene/quality_file.h"
#include "haptex/simulation/scene_explanation.h"

namespace {

constexpr const char* kUsage =
    "usage: explain_scene SCENE\n"
    "SCENE is the name of a scene of the package or the path of a scene file.\n";

}  // namespace

int main(int argc, char** argv) {
  const std::string scene = argc == 2 ? argv[1] : "";
  if (scene == "--help") {
    std::cout << kUsage;
    return 0;
  }
  if (argc != 2) {
    std::cerr << kUsage;
    return 2;
  }
  try {
    haptex::simulation::explainScene(
        haptex::nodes::findConfigFile("scenes", scene),
        haptex::scene::loadQualities(haptex::nodes::findConfigFile("presets", "front")), std::cout,
        std::cerr);
  } catch (const std::exception& error) {
    std::cerr << "explain_scene: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
