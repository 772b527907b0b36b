// The surface of a fabric, ready to be stroked.
#pragma once

#include <string>

#include "haptex/material/fabric.h"
#include "haptex/tactile/amplitude_map.h"
#include "haptex/tactile/stroke.h"

namespace haptex::tactile {

struct Surface {
  std::string fabric;  ///< its name
  SmallScale small_scale;
  AmplitudeMap large_scale;
};

/// Small and large scale of the relief in fabric.surface, scaled so that the virtual KES tester of
/// haptex/tactile/kes_surface.h finds its SMD and its MMD. The power of the waves is the variance
/// of the scaled relief.
///
/// A relief from a file that does not continue at its opposite edge loses its mean plane; the
/// tester passes over the seam. It and any that is larger than 128 x 128 samples is described by
/// the mean of the k-spaces of pieces of that size (kSpaceOfPiece()), so that stroking it costs no
/// more than stroking a weave; the power of the waves is then the mean of the variances about the
/// pieces' planes. Its large scale is the root mean square height in every cell of 1 mm about the
/// cell's mean, the same for both channels, or uniform if the field is shorter or narrower than
/// 10 mm or coarser than 0.25 mm.
/// @throws std::invalid_argument if the fabric has no surface or its relief is flat, what
///   loadHeights() throws for a relief in a file, weaveRelief() for a weave and knitRelief() for a
///   knit
Surface buildSurface(const material::Fabric& fabric);

/// The relief that buildSurface() scales: one from a file that does not continue at its opposite
/// edge without its mean plane.
/// @throws as buildSurface() for the relief
HeightField sampledRelief(const material::Surface& surface);

}  // namespace haptex::tactile
