// The command line of tactile_sound.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "haptex/tactile/contactor_sound.h"

namespace haptex::nodes {

/// A fabric that is rubbed.
struct FabricSound {
  std::string fabric;  ///< name of a shipped one or path of a fabric file
  tactile::Rubbing rubbing;
};

/// What a contactor did in a recording.
struct RecordedSound {
  std::string bag;
  std::string finger;
  int contactor = 0;
};

struct SoundRequest {
  std::variant<FabricSound, RecordedSound> source;
  std::string output;  ///< path of the WAV file
};

extern const char* const kSoundUsage;

/// @param arguments without the program's name
/// @throws std::invalid_argument naming the argument that is wrong, missing or unknown
SoundRequest parseSoundRequest(const std::vector<std::string>& arguments);

}  // namespace haptex::nodes
