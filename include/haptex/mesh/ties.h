// Ties of particles to edges, in terms of the particles that are free.
#pragma once

#include <cstddef>
#include <vector>

#include "haptex/mesh/mesh.h"

namespace haptex::mesh {

/// A free particle's share in the place of a tied one.
struct TieShare {
  int particle;
  double weight;  ///< not 0; those of a tied particle have the sum 1
};

/// Where a tied particle is: x = sum of weight x_particle.
struct ResolvedTie {
  int particle;
  std::vector<TieShare> shares;  ///< of particles that are not tied, ascending
};

/// Follows chains of ties, so that no tied particle depends on another tied one.
/// @param particle_count of the mesh
/// @returns one per tie, by particle
/// @throws std::invalid_argument if a particle does not exist, the two ends are one, a share is not
///   from 0 to 1, a particle is tied twice, or, through however many others, to itself
std::vector<ResolvedTie> resolveTies(const std::vector<Tie>& ties, std::size_t particle_count);

}  // namespace haptex::mesh
