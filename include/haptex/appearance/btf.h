// The bidirectional texture function of a fabric.
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "haptex/appearance/compressed_rows.h"
#include "haptex/appearance/directions.h"
#include "haptex/appearance/interreflection.h"
#include "haptex/tactile/relief_picture.h"

namespace haptex::appearance {

/// What of a light is seen, at every place of a fabric, from any direction: its relief with
/// masking, self-shadowing and interreflection. Which texel is seen and whether the light reaches
/// it are found on the relief, for each pair of directions anew, as both jump; what comes by way of
/// other texels, which is smooth, is stored by the texel for 81 views x 81 lights (directions.h),
/// compressed, and interpolated between them. Directions are those of directions.h.
class Btf {
 public:
  static constexpr int kColumns = kDirections * kDirections * 3;
  /// Of the stored matrix.
  static constexpr int columnOf(int view, int light) { return 3 * (kDirections * view + light); }

  /// @param indirect row per texel: radiance by light from other texels, 1/sr, for an irradiance
  ///   of 1 on the plane of the fabric
  /// @throws std::invalid_argument what Reflectance() throws, and if there is not a row for each
  ///   texel and a column for each pair and channel
  Btf(ReliefSurface surface, const material::Look& look, CompressedRows indirect);

  const ReliefSurface& surface() const { return surface_; }
  const Reflectance& reflectance() const { return reflectance_; }
  const CompressedRows& indirect() const { return indirect_; }
  /// Of heights, yarns and what is stored for them.
  std::size_t bytes() const;

  /// The function for one pair of directions. Not to be used longer than the Btf.
  class Pair {
   public:
    /// Radiance in red, green and blue, 1/sr, for an irradiance of 1 perpendicular to the light.
    /// Divided by the cosine of the light, it is the apparent bidirectional reflectance.
    /// @param seen m, on the plane at the height of the surface's highest place
    Eigen::Vector3d at(const Eigen::Vector2d& seen) const;

   private:
    friend class Btf;
    const Btf* btf_;
    Eigen::Vector3d view_, light_;
    Eigen::Vector3f mean_;
    Eigen::Matrix<float, 3, Eigen::Dynamic> basis_;
  };

  /// @param view, light towards the eye and the light, of any length
  /// @throws what soundDirection() throws
  Pair pair(const Eigen::Vector3d& view, const Eigen::Vector3d& light) const;

 private:
  ReliefSurface surface_;
  Reflectance reflectance_;
  CompressedRows indirect_;
};

/// Radiance of a point by light that reaches it directly, units as Btf::Pair::at().
Eigen::Vector3d directRadiance(const ReliefSurface& surface, const Reflectance& reflectance,
                               const ReliefSurface::Point& point, const Eigen::Vector3d& view,
                               const Eigen::Vector3d& light);

struct BtfSize {
  int columns;  ///< texels along weft
  int rows;     ///< texels along warp
  Compression compression;
};

/// @throws std::invalid_argument what ReliefSurface(), Reflectance() and compressRows() throw
Btf makeBtf(const tactile::FaceRelief& relief, const material::Look& look, const BtfSize& size);
/// Of light that is solved on its relief already. @throws std::invalid_argument what compressRows()
///   throws
Btf makeBtf(const Interreflection& light, const Compression& compression);

/// What is stored, before it is compressed: rows of Btf::kColumns values for compressRows().
class IndirectRows {
 public:
  /// @param interreflection used as long as this lives
  explicit IndirectRows(const Interreflection& interreflection);
  void operator()(int texel, float* values) const;

 private:
  const Interreflection* interreflection_;
  Interreflection::Light light_;
};

}  // namespace haptex::appearance
