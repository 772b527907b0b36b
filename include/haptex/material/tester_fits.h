// Curves and hysteresis of the raw loops that a tester has read.
#pragma once

#include <optional>
#include <vector>

#include "haptex/material/compression.h"
#include "haptex/material/fabric.h"
#include "haptex/material/monotone_fit.h"
#include "haptex/material/tester_file.h"

namespace haptex::material {

/// @throws std::invalid_argument of all functions here: what fitMonotone() refuses, readings that
/// are
///   missing or do not reach far enough, a loop that is the wrong way round

struct ElasticFit {
  PiecewiseCubic curve;  ///< second Piola-Kirchhoff stress (N/m) over Green-Lagrange strain
  std::size_t readings;  ///< used
  Residuals residuals;   ///< N/m
};

/// The curve of the first pull, as fabric files state it: through the loading branch.
ElasticFit fitTensile(const ReadingLoop& loop, int pieces);

/// Work of both branches by the trapezoidal rule in the tester's quantities: how much of it comes
/// back (KES RT over 100). Nothing without an unloading branch.
std::optional<double> tensileResilience(const ReadingLoop& loop);

/// A sample, and the threads that the tester's tension pulls while it is sheared.
struct ShearedSample {
  ReadingLoop loop;
  MembraneCurves pulled;
};

struct ShearFit {
  ElasticFit elastic;  ///< of positive strains: the middle of the loop
  std::optional<ShearHysteresis> hysteresis;
};

/// The middle of the loop and its width at once, by least squares over all samples, both branches
/// and both sides: readings are curve + width/2 while loading and curve - width/2 while unloading.
/// The width is constant up to 0.5 and from 5 degrees on, and straight between there and 2 and 3.5
/// degrees. Left out are readings within 0.5 degrees, where a new sample has not slipped yet, and
/// beyond 5 degrees those of unloading, where friction turns round.
/// @param stated width of the loop for samples without unloading branch, if known; else the curve
/// is
///   the loading branch
ShearFit fitShear(const std::vector<ShearedSample>& samples,
                  const std::optional<ShearHysteresis>& stated, int pieces);

struct BendingFit {
  double rigidity;                   ///< N.m
  std::optional<double> hysteresis;  ///< N; nothing without an unloading branch
  std::size_t readings;              ///< used
  Residuals residuals;               ///< N
};

/// As KES defines B and 2HB: straight lines through the readings of each branch from 50 to 150 /m,
/// both sides together; their mean slope, and their distance at 100 /m.
BendingFit fitBending(const ReadingLoop& loop);

struct CompressionFit {
  std::vector<ThicknessPoint> points;  ///< for compressionFromPoints()
  KesCompression kes;                  ///< of that curve
  std::optional<double> resilience;    ///< KES RC over 100; nothing without an unloading branch
  std::size_t readings;                ///< used
  Residuals residuals;                 ///< m, of the thickness by the curve of the points
};

/// The loading branch as a falling fit of thickness over the logarithm of pressure, from 0.5
/// gf/cm2, below which KES does not measure, to the largest pressure; below it the tangent, as
/// compressionFromKes() has it. Readings from half of 0.5 gf/cm2 on are used; they must reach from
/// 0.5 to 50 gf/cm2, within 2 %.
CompressionFit fitCompression(const ReadingLoop& loop, int pieces);

struct SurfaceFit {
  double friction;            ///< KES MIU: mean of the readings' magnitudes
  double friction_deviation;  ///< KES MMD: mean deviation from it
};

SurfaceFit fitSurface(const ReadingLoop& loop);

}  // namespace haptex::material
