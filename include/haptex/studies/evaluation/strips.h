// Manipulations of strips; manipulations() says what is done.
#pragma once

#include "haptex/material/fabric.h"
#include "haptex/studies/evaluation/device_record.h"
#include "haptex/studies/evaluation/manipulation_settings.h"

namespace haptex::studies {

/// How a strip is cut: its length along the warp, along the weft, or at 45 degrees to both.
enum class Cut { kWarp, kWeft, kBias };

/// @throws std::invalid_argument what oracles::HapticLoop throws for the fabric or the settings
DeviceRecord pressStrip(const material::Fabric& fabric, Cut cut,
                        const ManipulationSettings& settings);
/// @throws std::invalid_argument likewise
DeviceRecord lowerStrip(const material::Fabric& fabric, Cut cut,
                        const ManipulationSettings& settings);

}  // namespace haptex::studies
