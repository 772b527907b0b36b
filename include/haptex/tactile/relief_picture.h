// Reliefs as pictures, for programs that draw fabrics.
#pragma once

#include <string>
#include <vector>

#include "haptex/material/surface.h"
#include "haptex/tactile/height_field.h"

namespace haptex::tactile {

struct FaceRelief {
  HeightField heights;            ///< m, as the yarns lie: not scaled to SMD
  std::vector<bool> warp_on_top;  ///< which yarn is seen, index as of heights
};

/// The face of a fabric: sampledRelief(), whose heights of a knit have no size of their own: its
/// legs are as high here as half of their width, a quarter of a wale, as round yarns are. Of a
/// knit, which has one yarn, and of a relief from a file, which does not say, all is called warp.
/// @throws as sampledRelief()
FaceRelief faceRelief(const material::Surface& surface);

/// The heights as loadHeights() reads them: a 16-bit greyscale PNG whose first row lies at the
/// largest warp coordinate. Sample 0 is the lowest height, 65535 the highest.
/// @returns m, the highest above the lowest
/// @throws std::runtime_error naming the file if it cannot be written
double writeHeights(const HeightField& heights, const std::string& path);

/// Which yarn is seen, as an 8-bit greyscale PNG with rows in the same order: 0 weft, 255 warp.
/// @throws std::runtime_error naming the file if it cannot be written
void writeYarns(const FaceRelief& relief, const std::string& path);

}  // namespace haptex::tactile
