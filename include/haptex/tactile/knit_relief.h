// Reliefs of plain knits from the spacing of their loops.
#pragma once

#include "haptex/material/surface.h"
#include "haptex/tactile/amplitude_map.h"
#include "haptex/tactile/height_field.h"

namespace haptex::tactile {

/// A piece of the technical face of a plain (single jersey) knit with whole loops, up to 128 x 128
/// samples of about 0.1 mm: it continues at its opposite edge. The model is this package's own, as
/// simple as shows the V of every loop; the fabric's SMD sets its size.
///
/// Courses, the rows that a yarn knits, run along weft, `course` apart; wales, the columns of
/// loops, along warp, `wale` apart. What stands out on the face are the two legs of every loop, a
/// wale's side by side. With u along weft from the wale's middle, v along warp from the loop's,
/// both legs s = -1, 1 have the height
///   cos^2(2 pi (u - s m(v)) / wale) cos^2(pi v / (2 course)),   m(v) = wale/4 (1 + v/(2 course))
/// within wale/4 of their middle m(v) and within a course of the loop's: they lean outwards, and
/// each goes under the next loop where the one before comes up. Where legs overlap, the upper one
/// counts. Crowns have the height 1 m times the loop's variation.
///
/// Irregularity is the coefficient of variation of the loops, log-normal, correlated along the yarn
/// as yarnNoise() is; a loop takes 3.8 wales of yarn, that of a relaxed plain knit (Munden 1959, J.
/// Text. Inst. 50:T448). The same knit gives the same piece at every call.
/// @throws std::invalid_argument naming a parameter out of range: spacings of 0.4 to 6 mm,
///   irregularity 0 to 0.5
HeightField knitRelief(const material::Knit& knit);

/// How the amplitudes of the same fabric vary over 80 x 80 mm because its yarn does, course by
/// course; otherwise as weaveUnevenness().
/// @throws as knitRelief()
AmplitudeMap knitUnevenness(const material::Knit& knit);

}  // namespace haptex::tactile
