// What a scene file says about the stuffing of its cloth.
#pragma once

#include "haptex/base/yaml_reader.h"
#include "haptex/cloth/forces/stuffing/stuffing.h"

namespace haptex::scene {

/// @param scene that lists stuffing
/// @throws std::invalid_argument naming file, key and what is allowed if it lacks the key stuffing,
///   or lists fingers, too: their patches do not know its pressure
void requireStuffing(const base::YamlValue& scene, bool fingers);

/// @param value of the key stuffing: volume (m^3) and modulus (Pa), both finite and > 0
/// @throws std::invalid_argument naming file, key, value and what is allowed
cloth::StuffingMass readStuffing(const base::YamlValue& value);

}  // namespace haptex::scene
