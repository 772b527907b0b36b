// Bidirectional texture functions that were measured on a fabric.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "haptex/appearance/btf.h"

namespace haptex::appearance {

/// Photographs of a flat sample from the 81 directions of directions.h with light from each of
/// them, rectified, as the database of the University of Bonn has them (UBO2003; Sattler, Sarlette
/// and Klein, Efficient and realistic visualization of cloth, 2003): JPEG files anywhere below a
/// folder, whose names end like "tl075 pl345 tv015 pv060.jpg": polar angle and azimuth of the light
/// and of the view, in degrees. Azimuths count from weft towards warp, and the first row of a
/// picture lies at the largest warp coordinate.
///
/// Colours are sRGB; white is the radiance of a white matt surface with the light at its normal, so
/// that pictures of one and the same light and exposure need no more. Held are 19 683 bytes for
/// every texel.
class MeasuredImages {
 public:
  static constexpr int kMinSide = 4, kMaxSide = 256;  ///< texels

  /// @throws std::runtime_error naming the folder or file that cannot be read or is no JPEG file
  /// @throws std::invalid_argument naming a file with an angle that is not allowed, of a pair that
  ///   another file has, too, or of another size than the first, which is allowed from kMinSide to
  ///   kMaxSide; or how many pairs have no file, and the first of them
  explicit MeasuredImages(const std::string& folder);

  int columns() const { return columns_; }
  int rows() const { return rows_; }

  /// Writes Btf::kColumns values: radiance, 1/sr, for an irradiance of 1 on the plane of the
  /// fabric.
  /// @param texel from the lowest warp coordinate on, columns row + column
  void operator()(int texel, float* values) const;

 private:
  void take(const std::string& path, int column);

  int columns_ = 0, rows_ = 0;
  std::vector<std::uint8_t> values_;  // by texel and Btf::columnOf()
};

/// All light is stored by the place on the plane that the eye looks at, and interpolated between
/// the directions of the pictures, shadows included. The sample goes on without end, with its
/// seams.
/// @param width m, along weft, of what the pictures show
/// @throws std::invalid_argument naming a width that is not > 0 and finite, and what compressRows()
///   throws
Btf makeBtf(const MeasuredImages& images, double width, const Compression& compression);

/// Root mean square difference of what is stored from the pictures in their own directions, in
/// parts of the mean. @param btf of these images
double compressionError(const Btf& btf, const MeasuredImages& images);

}  // namespace haptex::appearance
