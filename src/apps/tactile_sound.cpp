// The program tactile_sound: a sound file of one contactor, see
// haptex/nodes/tactile_renderer/sound_request.h.
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "haptex/material/fabric_file.h"
#include "haptex/nodes/common/config_files.h"
#include "haptex/nodes/tactile_renderer/sound_request.h"
#include "haptex/nodes/tactile_renderer/tactile_recording.h"

namespace {

using namespace haptex;

tactile::ContactorSteps stepsOf(const nodes::FabricSound& sound) {
  const std::string path = nodes::findConfigFile("fabrics", sound.fabric);
  return tactile::rubbedSteps(tactile::buildSurface(material::loadFabric(path)), sound.rubbing);
}

tactile::ContactorSteps stepsOf(const nodes::RecordedSound& sound) {
  return nodes::recordedSteps(sound.bag, sound.finger, sound.contactor);
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (arguments == std::vector<std::string>{"--help"}) {
    std::fputs(nodes::kSoundUsage, stdout);
    return 0;
  }
  nodes::SoundRequest request;
  try {
    request = nodes::parseSoundRequest(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "tactile_sound: %s\n%s", error.what(), nodes::kSoundUsage);
    return 2;
  }
  try {
    const tactile::ContactorSteps steps =
        std::visit([](const auto& source) { return stepsOf(source); }, request.source);
    const tactile::WrittenSound sound = tactile::writeSound(request.output, steps);
    std::printf("%s: %.3f s, largest displacement %.2f um of %.0f um\n", request.output.c_str(),
                static_cast<double>(sound.samples) / tactile::kSoundRate, 1e6 * sound.largest,
                1e6 * tactile::kFullScale);
    if (sound.clipped > 0) {
      std::fprintf(stderr, "tactile_sound: %zu of %zu samples were beyond full scale and clipped\n",
                   sound.clipped, sound.samples);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "tactile_sound: %s\n", error.what());
    return 1;
  }
  return 0;
}
