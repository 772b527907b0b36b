// The oracles of the appearance room.
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "haptex/appearance/btf.h"
#include "haptex/appearance/btf_measures.h"
#include "haptex/base/repeatable_random.h"
#include "haptex/base/workload.h"
#include "haptex/oracles/checks/random_checks.h"
#include "haptex/oracles/checks/validation.h"
#include "haptex/oracles/exact/light_paths.h"
#include "haptex/oracles/experiments/known_surfaces.h"
#include "haptex/tactile/relief_picture.h"

namespace haptex::oracles {
namespace {

using appearance::Btf;
using appearance::Interreflection;
using appearance::ReliefSurface;
using Eigen::Vector3d;
using material::Look;

// Fewer texels than shipped, so that it takes seconds: steep slopes are a texel or two long.
constexpr int kTexels = 96;
constexpr appearance::BtfSize kSize{kTexels, kTexels, {24, 1, 24}};

const Look kWhite{{1.0, 1.0, 1.0}, {1.0, 1.0, 1.0}, 0.0, 1.0};
const Look kShiny{{0.7, 0.3, 0.1}, {0.2, 0.5, 0.8}, 0.2, 0.35};

std::string name(const std::string& what) { return "appearance/" + what; }

tactile::FaceRelief wovenRelief() {
  return tactile::faceRelief(
      {4e-6, 0.01,
       material::Weave{material::WeaveKind::kTwill31, {5e-4, 1e-4}, {5e-4, 1e-4}, 0.1}});
}

tactile::FaceRelief knittedRelief() {
  return tactile::faceRelief({4e-6, 0.01, material::Knit{1.6e-3, 1.2e-3, 0.1}});
}

tactile::FaceRelief furrows() {
  tactile::HeightField field = flatField(32, 32);
  addGrating(field, 2, 0, 2e-4);
  std::vector<bool> warp(field.heights.size(), true);
  return {std::move(field), std::move(warp)};
}

Vector3d towards(double polar_degrees, double azimuth_degrees) {
  const double polar = polar_degrees * M_PI / 180.0, azimuth = azimuth_degrees * M_PI / 180.0;
  return {std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
          std::cos(polar)};
}

/// A flat fabric reflects as its yarn does.
void validateFlat(const Sink& sink) {
  const Btf btf = appearance::makeBtf({flatField(16, 16), std::vector<bool>(256, true)}, kShiny,
                                      {16, 16, {1, 1, 1}});
  base::Quantity worst{name("flat_is_reflectance"), 0.0, 0.0, -1.0, 1e-7};
  for (double degrees = 0.0; degrees < 88.0; degrees += 7.0) {
    const Vector3d view = towards(degrees, 20.0), light = towards(80.0 - 0.8 * degrees, 200.0);
    const double exact = light.z() * btf.reflectance().of(true, Vector3d::UnitZ(), light, view).x();
    base::keepWorse(worst,
                    base::relativeTo(exact, worst.name, exact,
                                     btf.pair(view, light).at({1e-4, 3e-4}).x(), worst.tolerance));
  }
  sink(worst);
}

/// From the sky all of the surface is seen, so a surface sees as much of the sky, by the ratio of
/// the areas (reciprocity of view factors), whatever its shape.
base::Quantity shareOfSky(const std::string& name, const Interreflection& light, double tolerance) {
  const ReliefSurface& surface = light.surface();
  double open = 0.0, area = 0.0;
  for (int texel = 0; texel < surface.texels(); ++texel) {
    const double weight = 1.0 / surface.centreOf(texel).normal.z();
    open += weight * light.openShare(texel);
    area += weight;
  }
  return base::relativeTo(1.0, name, surface.texels() / area, open / area, tolerance);
}

void validateSky(const Sink& sink, const std::string& of, const tactile::FaceRelief& relief) {
  sink(shareOfSky(name("share_of_sky/" + of),
                  Interreflection(ReliefSurface(relief, kTexels, kTexels), kWhite), 0.01));
}

/// Against paths of light, mean over the repeat. Light flatter than 75 degrees goes between texels
/// as at 75, and few texels of the grid here are lit then.
void validatePaths(const Sink& sink, const std::string& of, const Btf& btf) {
  constexpr int kPaths = 224;
  struct Case {
    const char* name;
    Vector3d view, light;
    double tolerance;
  };
  const auto places = appearance::placesOver(btf.surface().size(), 128, 5);
  base::RepeatableRandom random(8);
  for (const Case& pair : {Case{"view10_light37", towards(10.0, 30.0), towards(37.0, 100.0), 0.02},
                           {"view67_light52", towards(67.0, 10.0), towards(52.0, 250.0), 0.02},
                           {"view82_light20", towards(82.0, 300.0), towards(20.0, 45.0), 0.02},
                           {"view40_light80", towards(40.0, 190.0), towards(80.0, 60.0), 0.05}}) {
    const double exact =
        radianceByPaths(btf.surface(), btf.reflectance(), pair.view, pair.light, kPaths, random)
            .sum();
    const double measured = meanRadiance(btf.pair(pair.view, pair.light), places).sum();
    sink(base::relativeTo(exact, name("paths/" + of + "/" + pair.name), exact, measured,
                          pair.tolerance));
  }
}

void validateFunction(const Sink& sink, const std::string& of, const tactile::FaceRelief& relief) {
  const Btf btf = makeBtf(relief, kShiny, kSize);
  validatePaths(sink, of, btf);
  const double reciprocity = reciprocityError(btf, {96, 16, 1, 1, 3});
  sink({name("reciprocity/" + of), 0.0, reciprocity, reciprocity, 0.02});
  const Interreflection exact(btf.surface(), kShiny);
  const double error = unsampledError(btf, exact, {24, 16, 1, 1, 3}).of_mean;
  sink({name("unsampled_directions/" + of), 0.0, error, error, 0.02});
}

void validateFurnace(const Sink& sink, const std::string& of, const tactile::FaceRelief& relief) {
  const double furnace = furnaceError(makeBtf(relief, kWhite, kSize), {4, 1, 64, 5, 3});
  sink({name("white_furnace/" + of), 1.0, 1.0 + furnace, furnace, 0.01});
}

}  // namespace

void validateAppearance(const std::string&, const Sink& sink) {
  validateFlat(sink);
  for (const auto& [of, relief] : {std::pair(std::string("furrows"), furrows()),
                                   {"twill", wovenRelief()},
                                   {"knit", knittedRelief()}}) {
    if (base::kSanitized && of == "twill") continue;
    validateSky(sink, of, relief);
    validateFurnace(sink, of, relief);
    validateFunction(sink, of, relief);
  }
}

/// Waves of any direction, up to as deep as a quarter of their length: the share of the sky is the
/// ratio of the areas, and of white all light that arrives leaves towards the sky.
void randomRelief(const std::string&, Random& random, const Sink& sink) {
  const int columns = 30 + random.below(30), rows = 30 + random.below(30);
  tactile::HeightField field = flatField(columns, rows);
  const int along_weft = 1 + random.below(2), along_warp = random.below(3);
  const double length = 1e-4 / std::hypot(static_cast<double>(along_weft) / columns,
                                          static_cast<double>(along_warp) / rows);
  const double depth = random.uniform(0.02, 0.25);
  addGrating(field, along_weft, along_warp, 0.5 * depth * length);
  const double polar = random.uniform(0.0, 60.0), azimuth = random.uniform(0.0, 360.0);
  CaseName text("appearance", "relief");
  text.with("depth", depth).with("polar", polar).with("azimuth", azimuth);
  const std::vector<bool> warp(field.heights.size(), true);
  const Interreflection light(ReliefSurface({field, warp}, 72, 72), kWhite);
  sink(shareOfSky(text.text() + "/share_of_sky", light, 0.015));
  const Vector3d sun = towards(polar, azimuth);
  const Interreflection::Light solved = light.solve({sun});
  double sent = 0.0;
  for (int texel = 0; texel < light.surface().texels(); ++texel) {
    sent += light.openShare(texel) * solved.radiosity(texel, 0) /
            light.surface().centreOf(texel).normal.z();
  }
  sink(base::relativeTo(sun.z(), text.text() + "/light_sent_back", sun.z(),
                        sent / light.surface().texels(), 0.005));
}

}  // namespace haptex::oracles
