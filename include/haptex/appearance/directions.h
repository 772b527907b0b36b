// The directions that a bidirectional texture function is sampled in, and what lies between them.
#pragma once

#include <Eigen/Core>
#include <array>

namespace haptex::appearance {

constexpr int kDirections = 81;

/// Least height of a unit direction above the plane of the fabric; flatter ones are taken as this
/// flat (0.57 degrees), where a ray still meets the relief after a few repeats.
constexpr double kFlattest = 0.01;

/// Unit directions away from the fabric: x along weft, y along warp, z out of its face. 1, 6, 12,
/// 18, 20 and 24 of them, evenly around, at 0, 15, 30, 45, 60 and 75 degrees from z, ring by ring
/// (Sattler, Sarlette and Klein, Efficient and realistic visualization of cloth, 2003).
const std::array<Eigen::Vector3d, kDirections>& sampledDirections();

/// A direction as a mean of sampled ones.
struct DirectionWeights {
  std::array<int, 4> index;
  std::array<double, 4> weight;  ///< >= 0, of sum 1
};

/// Linear in the angle from z between the two nearest rings, and around each of them; beyond 75
/// degrees as at 75. Continuous, and exact in the sampled directions.
/// @param direction sound, see below
DirectionWeights weightsOf(const Eigen::Vector3d& direction);

/// @returns the direction at length 1, not flatter than kFlattest
/// @throws std::invalid_argument naming the direction unless it is finite and z > 0
Eigen::Vector3d soundDirection(const char* name, const Eigen::Vector3d& direction);

}  // namespace haptex::appearance
