// How finely and by which method a cloth is computed, and what that was measured to cost and miss.
#pragma once

#include <string>
#include <vector>

#include "haptex/cloth/dynamics/step.h"

namespace haptex::scene {

/// What a quality missed in one motion of the trade-off study against a converged reference, and
/// took: root mean squares over the motion. docs/trade_off.md defines motions and measures.
struct MeasuredQuality {
  std::string motion;           ///< hang, swing, stretch, drape or fold
  std::string fabric;           ///< name of a file in config/fabrics
  double position_error = 0.0;  ///< m
  double force_error = 0.0;     ///< N, of what holds the cloth
  double energy_error = 0.0;    ///< J
  double cost = 0.0;            ///< computing time per simulated time, on the machine of the study
};

/// A point of the front between cost and error: a choice of settings, with what it was measured to
/// give. Files in config/presets hold them.
struct Quality {
  std::string name;
  std::string fabric;      ///< of config/fabrics, on whose front it lies; empty: for any fabric
  double cell_size = 0.0;  ///< m, largest edge length of the cells of a sheet
  double time_step = 0.0;  ///< s, largest
  cloth::StepSettings step;
  std::vector<MeasuredQuality> measured;
};

}  // namespace haptex::scene
