// Measured reliefs from files.
#pragma once

#include "haptex/material/surface.h"
#include "haptex/tactile/height_field.h"

namespace haptex::tactile {

/// Heights from a 16-bit greyscale PNG (.png) or from a raw file (.raw): little-endian 16-bit
/// unsigned samples row by row, after the number of columns and of rows, both such samples too. The
/// first row lies at the largest warp coordinate, as a picture is looked at. Sample 0 is height 0,
/// 65535 is file.height. Samples of a PNG are taken as they are, whatever gamma it states.
/// @throws std::runtime_error naming the file if it cannot be read or is damaged, and what it is
///   instead of a 16-bit greyscale PNG or of a raw file of that size; std::invalid_argument naming
///   file, size and what is allowed, as requireSound(), or the spacing or height unless it is
///   finite and > 0
HeightField loadHeights(const material::HeightFile& file);

}  // namespace haptex::tactile
