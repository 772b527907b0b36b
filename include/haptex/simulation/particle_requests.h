// How requests that name particles are checked.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "haptex/mesh/mesh.h"

namespace haptex::simulation {

/// "array[index]"
std::string element(const std::string& array, std::size_t index);

/// @param count of the cloth's particles
/// @throws std::invalid_argument naming the first of `particles` that does not exist or is named
///   twice
void requireParticles(const std::vector<std::uint32_t>& particles, std::size_t count);

/// Those that are named, then, ascending, the others whose rest coordinates lie in a region.
/// @param weft, warp from and to (m), borders included; both empty: no region
/// @throws std::invalid_argument also if an extent has not two finite numbers, the first not
///   larger than the second, or there is a region and no particle is named or lies in it
std::vector<std::uint32_t> selectedParticles(const mesh::ClothMesh& mesh,
                                             const std::vector<std::uint32_t>& particles,
                                             const std::vector<double>& weft,
                                             const std::vector<double>& warp);

/// @param size  of the array `name` @param count what it has to have, one for each particle
/// @param instead what else would be allowed, for example "none"; may be empty
/// @throws std::invalid_argument naming both
void requireOneEach(const char* name, std::size_t size, std::size_t count,
                    const std::string& instead = "");

/// @throws std::invalid_argument naming the vector unless its components are finite and from -limit
///   to limit
void requireWithin(const std::string& name, const Eigen::Vector3d& vector, double limit,
                   const char* unit);

/// The same of all vectors of the array `name`.
void requireAllWithin(const char* name, const std::vector<Eigen::Vector3d>& vectors, double limit,
                      const char* unit);

}  // namespace haptex::simulation
