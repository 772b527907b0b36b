// The largest stiffness of a virtual wall that the simulated exoskeleton renders well.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <sstream>
#include <string>

#include "haptex/oracles/experiments/virtual_wall.h"
#include "tab_lines.h"

namespace haptex::bench {

constexpr double kSoftest = 100.0, kStiffest = 6400.0;  // N/m, where to look
constexpr int kHalvings = 7;                            // of that range: to 3 %
constexpr int kSearchCycles = 10, kCycles = 100;        // while searching, and in the end
constexpr double kStepBack = 0.97;                      // where the limit did not bear kCycles

using base::Finger;
using base::kFingers;
using base::PerFinger;

/// What is asked of a wall: steady, and if `passive`, observed to be passive as well.
inline bool good(const oracles::WallTouch& touch, bool passive) {
  return touch.steady() && (!passive || touch.observedPassive());
}

struct Limit {
  double stiffness = 0.0;  // N/m, 0 if not even kSoftest is good
  oracles::WallTouch touch;
};

/// By bisection, both fingers at a time; the walls differ from `wall` in their stiffness.
class WallSearch {
 public:
  WallSearch(const std::string& urdf, const exoskeleton::FingerMechanics& mechanics,
             const PerFinger<Eigen::Vector3d>& open, const oracles::VirtualWall& wall)
      : urdf_(urdf), mechanics_(mechanics), open_(open), wall_(wall) {}

  PerFinger<Limit> find(bool passive) {
    PerFinger<double> low{{kSoftest, kSoftest}}, high{{kStiffest, kStiffest}};
    for (int i = 0; i < kHalvings; ++i) {
      PerFinger<double> middle;
      for (const Finger finger : kFingers) middle[finger] = std::sqrt(low[finger] * high[finger]);
      const PerFinger<oracles::WallTouch> touches = touch(middle, kSearchCycles);
      for (const Finger finger : kFingers) {
        (good(touches[finger], passive) ? low : high)[finger] = middle[finger];
      }
    }
    return confirm(low, passive);
  }

 private:
  PerFinger<oracles::WallTouch> touch(const PerFinger<double>& stiffness, int cycles) const {
    PerFinger<oracles::VirtualWall> walls{{wall_, wall_}};
    for (const Finger finger : kFingers) walls[finger].stiffness = stiffness[finger];
    return oracles::touchWalls(urdf_, mechanics_, open_, walls, cycles);
  }

  PerFinger<Limit> confirm(PerFinger<double> stiffness, bool passive) const {
    PerFinger<Limit> limits;
    for (bool found = false; !found;) {
      found = true;
      const PerFinger<oracles::WallTouch> touches = touch(stiffness, kCycles);
      for (const Finger finger : kFingers) {
        const bool is_good = good(touches[finger], passive);
        limits[finger] = {is_good ? stiffness[finger] : 0.0, touches[finger]};
        if (is_good || stiffness[finger] < kSoftest) continue;
        stiffness[finger] *= kStepBack;
        found = false;
      }
    }
    return limits;
  }

  std::string urdf_;
  exoskeleton::FingerMechanics mechanics_;
  PerFinger<Eigen::Vector3d> open_;
  oracles::VirtualWall wall_;
};

/// wall_stiffness: steady and observed to be passive; wall_steady: steady, whatever the passivity
/// controller does. For the latter, what the device gave to the person and how often the
/// controller acted at that limit.
inline void printWallStiffness(const std::string& urdf, const std::string& person,
                               const exoskeleton::FingerMechanics& mechanics,
                               const PerFinger<Eigen::Vector3d>& open,
                               const oracles::VirtualWall& wall) {
  WallSearch search(urdf, mechanics, open, wall);
  const PerFinger<Limit> passive = search.find(true), steady = search.find(false);
  for (const Finger finger : kFingers) {
    std::ostringstream name;
    name << '/' << (wall.linearised ? "linearised" : "sample") << "_delay_" << wall.delay
         << "ms_damping_" << wall.damping << '_' << person << '_' << base::name(finger);
    const Limit& limit = steady[finger];
    printLine("exoskeleton/wall_stiffness" + name.str(), passive[finger].stiffness, "N/m");
    printLine("exoskeleton/wall_steady" + name.str(), limit.stiffness, "N/m");
    printLine("exoskeleton/wall_steady_energy_given" + name.str(), 1e3 * limit.touch.given_energy,
              "mJ per cycle");
    printLine("exoskeleton/wall_steady_controller_acts" + name.str(),
              100.0 * limit.touch.controller_share, "% of ticks");
  }
}

}  // namespace haptex::bench
