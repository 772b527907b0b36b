// What of a bidirectional texture function should be stored? Three ways, compressed to what takes
// at most 24 MB for 256 x 256 texels, against direct ray casting in directions that were not
// sampled, in parts of the mean radiance:
//   plane      all light, by the place on the plane of the fabric that the eye looks at
//   texel      all light, by the texel that is seen there, which the relief tells
//   shipped    light from other texels, by the texel; the relief also tells where the sun shines
// All are computed for 96 x 96 texels, the first two with as many components as 256 x 256 would
// have. Then what components and clusters do for the third.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "haptex/appearance/btf.h"
#include "haptex/appearance/btf_measures.h"
#include "haptex/base/repeatable_random.h"
#include "haptex/material/fabric_file.h"
#include "tab_lines.h"

namespace {

using namespace haptex;
using appearance::Btf;
using appearance::CompressedRows;
using appearance::Compression;
using appearance::Interreflection;
using appearance::kDirections;
using appearance::ReliefSurface;
using bench::printLine;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kTexels = 96;
constexpr int kPlaces = 32, kPairs = 24;

struct Fabric {
  tactile::FaceRelief relief;
  material::Look look;
};

Fabric load(const std::string& name) {
  const material::Fabric fabric =
      material::loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/" + name + ".yaml");
  return {tactile::faceRelief(*fabric.surface), *fabric.look};
}

/// Radiance by all light for an irradiance of 1 on the plane, for all pairs of sampled directions.
class AllLight {
 public:
  explicit AllLight(const Btf& btf) : btf_(&btf), lit_(btf.surface().texels()) {
    for (int texel = 0; texel < btf.surface().texels(); ++texel) {
      const ReliefSurface::Point centre = btf.surface().centreOf(texel);
      for (const Vector3d& light : appearance::sampledDirections()) {
        lit_[texel].push_back(centre.normal.dot(light) > 0.0 && !btf.surface().met(centre, light));
      }
    }
  }

  void ofTexel(int texel, float* values) const {
    for (int view = 0; view < kDirections; ++view) {
      put(texel, view, values + Btf::columnOf(view, 0));
    }
  }

  /// @param texel of the plane
  void ofPlace(int texel, float* values) const {
    const ReliefSurface& surface = btf_->surface();
    const Vector2d size = surface.size();
    const int column = texel % surface.columns(), row = texel / surface.columns();
    const Vector2d place((column + 0.5) * size.x() / surface.columns(),
                         (row + 0.5) * size.y() / surface.rows());
    for (int view = 0; view < kDirections; ++view) {
      const Vector3d& direction = appearance::sampledDirections()[view];
      put(surface.seenAt(place, direction).texel, view, values + Btf::columnOf(view, 0));
    }
  }

 private:
  void put(int texel, int view, float* values) const {
    const CompressedRows& indirect = btf_->indirect();
    constexpr int kCount = 3 * kDirections;
    Eigen::Map<Eigen::VectorXf> sum(values, kCount);
    const int first = Btf::columnOf(view, 0);
    sum = indirect.mean.segment(first, kCount) +
          indirect.basis.middleCols(first, kCount).transpose() * indirect.coordinates(texel);
    const ReliefSurface::Point centre = btf_->surface().centreOf(texel);
    const bool warp = btf_->surface().warpOnTop()[texel];
    const auto& directions = appearance::sampledDirections();
    for (int light = 0; light < kDirections; ++light) {
      if (!lit_[texel][light]) continue;
      const Vector3d& towards = directions[light];
      sum.segment<3>(3 * light) +=
          (centre.normal.dot(towards) / towards.z() *
           btf_->reflectance().of(warp, centre.normal, towards, directions[view]))
              .cast<float>();
    }
  }

  const Btf* btf_;
  std::vector<std::vector<bool>> lit_;
};

/// What interpolation between the sampled directions gives.
Vector3d interpolated(const CompressedRows& rows, int row, const Vector3d& view,
                      const Vector3d& light) {
  const auto views = appearance::weightsOf(view), lights = appearance::weightsOf(light);
  const Eigen::VectorXf coordinates = rows.coordinates(row);
  Vector3d sum = Vector3d::Zero();
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      const int column = Btf::columnOf(views.index[i], lights.index[j]);
      const Eigen::Vector3f value =
          rows.mean.segment<3>(column) + rows.basis.middleCols<3>(column).transpose() * coordinates;
      sum += views.weight[i] * lights.weight[j] * light.z() * value.cast<double>();
    }
  }
  return sum;
}

/// Root mean square of the difference from direct ray casting, by the mean.
template <typename RadianceAt>
double error(const Interreflection& exact, const RadianceAt& radiance_at) {
  base::RepeatableRandom random(7);
  const ReliefSurface& surface = exact.surface();
  const auto places = appearance::placesOver(surface.size(), kPlaces, 7);
  double squares = 0.0, sum = 0.0;
  for (int i = 0; i < kPairs; ++i) {
    Vector3d view = random.direction(), light = random.direction();
    for (Vector3d* direction : {&view, &light}) {
      direction->z() = std::abs(direction->z());
      *direction = appearance::soundDirection("pair", *direction);
    }
    const Interreflection::Light solved = exact.solve({light});
    for (const Vector2d& place : places) {
      const ReliefSurface::Point point = surface.seenAt(place, view);
      const Vector3d right =
          directRadiance(surface, exact.reflectance(), point, view, light) +
          exact.send(point.texel, solved, {view}).row(0).transpose().cast<double>();
      squares += (radiance_at(place, point, view, light) - right).squaredNorm();
      sum += right.sum();
    }
  }
  return std::sqrt(squares * 3.0 * kPairs * static_cast<double>(places.size())) / sum;
}

void compare(const std::string& name) {
  const Fabric fabric = load(name);
  const Interreflection exact(ReliefSurface(fabric.relief, kTexels, kTexels), fabric.look);
  const ReliefSurface& surface = exact.surface();
  const Btf btf = appearance::makeBtf(fabric.relief, fabric.look, {kTexels, kTexels, {96, 1, 96}});
  const AllLight all(btf);
  const auto print = [&](const std::string& way, double value) {
    printLine("btf_storage/" + name + "/" + way, value, "of the mean");
  };
  for (const Compression& size : {Compression{112, 1, 112}, Compression{128, 64, 80}}) {
    const std::string clusters = "/clusters=" + std::to_string(size.clusters);
    const CompressedRows by_place = appearance::compressRows(
        surface.texels(), Btf::kColumns, [&](int row, float* values) { all.ofPlace(row, values); },
        size);
    print("plane" + clusters, error(exact, [&](const Vector2d& place, const ReliefSurface::Point&,
                                               const Vector3d& view, const Vector3d& light) {
            const Vector2d at = place.cwiseQuotient(surface.size()) * kTexels;
            return interpolated(by_place,
                                kTexels * std::min(static_cast<int>(at.y()), kTexels - 1) +
                                    std::min(static_cast<int>(at.x()), kTexels - 1),
                                view, light);
          }));
    const CompressedRows by_texel = appearance::compressRows(
        surface.texels(), Btf::kColumns, [&](int row, float* values) { all.ofTexel(row, values); },
        size);
    print("texel" + clusters, error(exact, [&](const Vector2d&, const ReliefSurface::Point& point,
                                               const Vector3d& view, const Vector3d& light) {
            return interpolated(by_texel, point.texel, view, light);
          }));
  }
  for (const Compression& size : {Compression{8, 1, 8}, Compression{32, 1, 32},
                                  Compression{96, 1, 96}, Compression{96, 64, 32}}) {
    const Btf shipped = appearance::makeBtf(fabric.relief, fabric.look, {kTexels, kTexels, size});
    const std::string way = "shipped/components=" + std::to_string(size.components) +
                            "/clusters=" + std::to_string(size.clusters) +
                            "/local=" + std::to_string(size.local);
    print(way,
          error(exact, [&](const Vector2d& place, const ReliefSurface::Point&, const Vector3d& view,
                           const Vector3d& light) { return shipped.pair(view, light).at(place); }));
    printLine("btf_storage/" + name + "/" + way + "/size", 1e-6 * shipped.bytes(), "MB");
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1) {
    for (int i = 1; i < argc; ++i) compare(argv[i]);
    return 0;
  }
  for (const char* name : {"denim", "polyester_satin"}) compare(name);
}
