// The program explain_scene: what a scene models, at what cost and error. Needs no ROS master.
#include <iostream>

#include "haptex/base/command_line.h"
#include "haptex/nodes/common/config_files.h"
#include "haptex/scene/quality_file.h"
#include "haptex/simulation/scene_explanation.h"

namespace {

constexpr const char* kUsage =
    "usage: explain_scene SCENE\n"
    "SCENE is the name of a scene of the package or the path of a scene file.\n";

}  // namespace

int main(int argc, char** argv) {
  using haptex::nodes::findConfigFile;
  return haptex::base::runPlainProgram(
      "explain_scene", kUsage, {argv + 1, argv + argc}, 1, 1, [](const auto& arguments) {
        haptex::simulation::explainScene(
            findConfigFile("scenes", arguments[0]),
            haptex::scene::loadQualities(findConfigFile("presets", "front")), std::cout, std::cerr);
      });
}
