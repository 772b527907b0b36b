// How yarns vary along their length, and what of it is felt over a larger area.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "haptex/tactile/amplitude_map.h"

namespace haptex::tactile {

constexpr int kMapCells = 80;  ///< along a side of the map of unevenness

/// Numbers of a standard normal distribution, the same on every platform and at every run: the
/// standard fixes what the generator gives, but not what its own normal distribution makes of it.
class NormalNumbers {
 public:
  double next();

 private:
  double uniform();  // below 1

  std::mt19937_64 generator_{6};  // any seed
};

/// A closed yarn's deviation at evenly spaced places: mean 0, variance 1, and of places d apart
/// (the shorter way round) the correlation
///   1 - d/(40 mm), none beyond,
/// that of fibres of 40 mm, the length of cotton's, strewn at random (Martindale 1945, J. Text.
/// Inst. 36:T35).
/// @param places >= 1
/// @param length m, of the yarn all the way round, > 0
std::vector<double> yarnNoise(NormalNumbers& numbers, int places, double length);

/// A log-normal factor, so that nothing that it multiplies becomes negative: mean 1, coefficient of
/// variation as given.
/// @param noise of standard deviation 1
double variation(double noise, double irregularity);

/// Parallel yarns.
struct ParallelYarns {
  double spacing;            ///< m, from one to the next, > 0
  double length_per_length;  ///< of a yarn over the fabric's that it takes, >= 1
};

/// Mean square factor of the yarns in every cell of a map of kMapCells x kMapCells, each 1 mm wide:
/// index kMapCells across + along.
std::vector<double> cellPowers(NormalNumbers& numbers, const ParallelYarns& yarns,
                               double irregularity);

/// The map, in both channels alike, whose squares are as the powers, of mean square 1.
/// @param powers > 0; index kMapCells warp + weft
AmplitudeMap mapOfPowers(const std::vector<double>& powers);

}  // namespace haptex::tactile
