// Reliefs of woven fabrics from the parameters of their weave.
#pragma once

#include <vector>

#include "haptex/material/surface.h"
#include "haptex/tactile/amplitude_map.h"
#include "haptex/tactile/height_field.h"

namespace haptex::tactile {

/// A piece of the relief with whole repeats of the weave, up to 128 x 128 samples and mostly 8 to
/// 13 mm long and wide: it continues at its opposite edge. Yarns are sampled a whole number of
/// times, at least 4, as near to 0.1 mm as that allows. The model is this package's own, as simple
/// as shows a weave; the fabric's SMD sets its size.
///
/// Weft yarns run along weft, weft.spacing apart along warp, and warp yarns the other way round.
/// Height is the sum of both systems over the middle of the fabric. Across, a yarn is as wide as
/// its spacing and falls off as cos^2(pi distance/spacing). Along, it has its system's height in
/// the middle of the crossings where it lies on top and none where it goes under, and goes from
/// that of one crossing to that of the next along half a cosine: floats do not dip. Which warp yarn
/// i lies on top of which weft yarn j:
///   plain         i + j even
///   twill 2/2     i - j modulo 4 is 0 or 1: lines go up to the right
///   twill 3/1     i - j modulo 4 is not 3
///   satin         j - 2i modulo 5 is not 0: the warp shows
///   rib           as plain, where a weft yarn j is two that lie together, as one of twice the
///                 width: ribs along weft
///
/// Irregularity is the coefficient of variation of the crowns. They are log-normal; those of
/// different yarns are independent, those of one yarn correlated over 40 mm, the length of cotton
/// fibres, so that along the piece they vary little. The same weave gives the same piece at every
/// call.
/// @throws std::invalid_argument naming a parameter out of range: spacings of 0.2 to 3 mm, heights
///   >= 0 of which one is > 0, irregularity 0 to 0.5
HeightField weaveRelief(const material::Weave& weave);

/// Which system is seen from the face at every sample of weaveRelief(), true for the warp: the one
/// that is higher there, and where both are as high the one on top at the nearest crossing.
/// @returns index columns row + column of the relief
/// @throws as weaveRelief()
std::vector<bool> warpsOnTop(const material::Weave& weave);

/// How the amplitudes of the same fabric vary over 80 x 80 mm because its yarns do along their
/// length: in every cell of 1 mm the root mean square of the yarns in it, as irregular and as
/// correlated as those of weaveRelief(), by the square of the systems' heights. Finer yarns average
/// out more. Both channels are alike: higher yarns are felt more at every frequency. Mean square 1;
/// uniform without irregularity.
/// @throws as weaveRelief()
AmplitudeMap weaveUnevenness(const material::Weave& weave);

}  // namespace haptex::tactile
