// Fingertips that touch a sample along prescribed paths, and the forces that they should feel.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <string>
#include <vector>

#include "haptex/oracles/experiments/contact_scenes.h"

namespace haptex::oracles {

/// A touch that is the same however finely it is computed: the sample's initial positions are in
/// equilibrium, nothing touches at the time 0, and the fingertips move as functions of time alone.
struct PrescribedTouch {
  std::string name;
  HapticLoopSettings sample;
  Eigen::AlignedBox2d touched;  ///< m, rest coordinates where fingertips press the fabric
  double duration = 0.0;        ///< s
  double rest_from = 0.0;       ///< s: the fingertips stay where they are until the end
  std::function<Fingertips(double)> fingertips;  ///< at a time (s)
};

/// The 200 mm sample of a fabric with compression and friction. Along minimum-jerk paths:
/// press: one fingertip into the taut sample;
/// pull: two fingertips pinch the hanging sample and pull it along the warp;
/// slide: one fingertip presses into the taut sample and slides over it, across the mesh.
/// Nothing happens in a symmetric place of the mesh.
/// @throws what cloth::Cloth, contact::ContactLaw and Equilibrium throw
std::vector<PrescribedTouch> prescribedTouches(const material::Fabric& fabric);

/// The forces on the fingertips (N, world), `interval` apart; the first at one interval.
struct ForceRecord {
  double interval = 0.0;  ///< s
  std::vector<base::PerFinger<Eigen::Vector3d>> forces;
};

/// Time between two records (s): the shortest tick that is compared.
constexpr double kRecordInterval = 5e-4;

/// The whole sample in one layer (RefinedCloth) on a mesh of its own, whose lines are
/// gradedLines().
/// @param cell   m, of the touched part
/// @param growth > 1, from a cell to the next one outside
/// @param steps_per_record of linearised backward Euler in kRecordInterval
/// @throws what gradedLines() and RefinedCloth throw, std::invalid_argument if steps_per_record < 1
ForceRecord computeInOneLayer(const PrescribedTouch& touch, double cell, double growth,
                              int steps_per_record);

/// The same sample on other cells: lines of the mesh at these rest coordinates (m), ascending, from
/// 0 to the sample's side. Initial positions are interpolated.
/// @param sample of as many square cells along weft as along warp
HapticLoopSettings onLines(const HapticLoopSettings& sample, const std::vector<double>& weft,
                           const std::vector<double>& warp);

/// Lines (m) from 0 to `length`: at most `cell` apart from `low` to `high`; outside each is at most
/// `growth` times as far from the next as the one before.
/// @throws std::invalid_argument unless 0 < low < high < length, cell > 0 and growth > 1, all
/// finite
std::vector<double> gradedLines(double length, double low, double high, double cell, double growth);

}  // namespace haptex::oracles
