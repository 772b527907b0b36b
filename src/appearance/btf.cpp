#include "haptex/appearance/btf.h"

#include <utility>

#include "haptex/base/require.h"

namespace haptex::appearance {

using Eigen::Vector2d;
using Eigen::Vector3d;

Btf::Btf(ReliefSurface surface, const material::Look& look, CompressedRows indirect)
    : surface_(std::move(surface)), reflectance_(look), indirect_(std::move(indirect)) {
  if (indirect_.rows() != surface_.texels() || indirect_.columns() != kColumns) {
    base::refuse("the light between texels is stored for ", indirect_.rows(), " texels and ",
                 indirect_.columns(), " pairs and channels: needed are ", surface_.texels(),
                 " and ", kColumns);
  }
}

std::size_t Btf::bytes() const {
  // Heights in four bytes, and a byte for the yarn.
  return 5 * static_cast<std::size_t>(surface_.texels()) + indirect_.bytes();
}

Btf::Pair Btf::pair(const Vector3d& view, const Vector3d& light) const {
  Pair pair;
  pair.btf_ = this;
  pair.view_ = soundDirection("view", view);
  pair.light_ = soundDirection("light", light);
  pair.mean_.setZero();
  pair.basis_.setZero(3, indirect_.size.components);
  const DirectionWeights views = weightsOf(pair.view_), lights = weightsOf(pair.light_);
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      // Stored for an irradiance of 1 on the plane, which is the cosine here.
      const auto weight = static_cast<float>(views.weight[i] * lights.weight[j] * pair.light_.z());
      const int column = columnOf(views.index[i], lights.index[j]);
      pair.mean_ += weight * indirect_.mean.segment<3>(column);
      pair.basis_ += weight * indirect_.basis.middleCols<3>(column).transpose();
    }
  }
  return pair;
}

Vector3d Btf::Pair::at(const Vector2d& seen) const {
  const ReliefSurface::Point point = btf_->surface_.seenAt(seen, view_);
  const Eigen::Vector3f indirect = mean_ + basis_ * btf_->indirect_.coordinates(point.texel);
  return directRadiance(btf_->surface_, btf_->reflectance_, point, view_, light_) +
         indirect.cwiseMax(0.0f).cast<double>();
}

Vector3d directRadiance(const ReliefSurface& surface, const Reflectance& reflectance,
                        const ReliefSurface::Point& point, const Vector3d& view,
                        const Vector3d& light) {
  const double cosine = point.normal.dot(light);
  if (!(cosine > 0.0) || surface.met(point, light)) return Vector3d::Zero();
  return cosine * reflectance.of(surface.warpOnTop()[point.texel], point.normal, light, view);
}

IndirectRows::IndirectRows(const Interreflection& interreflection)
    : interreflection_(&interreflection),
      light_(interreflection.solve({sampledDirections().begin(), sampledDirections().end()})) {}

void IndirectRows::operator()(int texel, float* values) const {
  Eigen::Map<Interreflection::Matrix> row(values, kDirections, 3 * kDirections);
  row = interreflection_->send(texel, light_, light_.directions);
  for (int light = 0; light < kDirections; ++light) {
    row.middleCols<3>(3 * light) /= static_cast<float>(light_.directions[light].z());
  }
}

Btf makeBtf(const tactile::FaceRelief& relief, const material::Look& look, const BtfSize& size) {
  requireSound(size.compression);
  return makeBtf(Interreflection(ReliefSurface(relief, size.columns, size.rows), look),
                 size.compression);
}

Btf makeBtf(const Interreflection& light, const Compression& compression) {
  CompressedRows indirect =
      compressRows(light.surface().texels(), Btf::kColumns, IndirectRows(light), compression);
  return Btf(light.surface(), light.reflectance().look(), std::move(indirect));
}

}  // namespace haptex::appearance
