// The fabric files that the package ships, against their own numbers read without the loader.
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "haptex/material/fabric_file.h"
#include "haptex/material/strain_measures.h"

namespace haptex::material::test_shipped_fabrics {
namespace {

const std::filesystem::path kFabrics = HAPTEX_CONFIG_DIRECTORY "/fabrics";

Fabric shipped(const std::string& name) {
  return loadFabric((kFabrics / (name + ".yaml")).string());
}

std::vector<CurvePoint> pointsInFile(const std::string& name, const std::string& direction) {
  const YAML::Node file = YAML::LoadFile((kFabrics / (name + ".yaml")).string());
  std::vector<CurvePoint> points;
  for (const YAML::Node& point : file[direction]["elastic"]["points"]) {
    points.push_back({point[0].as<double>(), point[1].as<double>()});
  }
  return points;
}

std::vector<std::string> shippedNames() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(kFabrics)) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

struct WoolCurve {
  std::string direction;
  StrainStressCurve curve;
  std::vector<CurvePoint> points;
};

std::vector<WoolCurve> woolCurves() {
  const Fabric wool = shipped("wool");
  return {{"weft", wool.weft.elastic, pointsInFile("wool", "weft")},
          {"warp", wool.warp.elastic, pointsInFile("wool", "warp")},
          {"shear", wool.shear.elastic, pointsInFile("wool", "shear")}};
}

TEST(ShippedFabrics, LoadUnderTheirFileNames) {
  EXPECT_EQ(shippedNames(),
            (std::vector<std::string>{"acrylic_knit", "cotton_canvas", "cotton_knit",
                                      "cotton_poplin", "cotton_rep", "denim", "linear", "linen",
                                      "polyester_satin", "silk_habutae", "wool", "wool_tropical",
                                      "worsted_gabardine", "worsted_serge"}));
  for (const std::string& name : shippedNames()) {
    const Fabric fabric = shipped(name);
    EXPECT_EQ(fabric.name, name);
    EXPECT_FALSE(fabric.description.empty()) << name;
  }
}

TEST(ShippedFabrics, AreTheSameFromTheTextThatTheyCarry) {
  for (const std::string& name : shippedNames()) {
    const Fabric fabric = shipped(name);
    const Fabric again = parseFabric(fabric.file, "text");
    EXPECT_EQ(again.name, fabric.name);
    EXPECT_EQ(again.areal_density, fabric.areal_density) << name;
    EXPECT_EQ(again.warp.elastic.energy(0.01), fabric.warp.elastic.energy(0.01)) << name;
    EXPECT_EQ(again.provenance.size(), fabric.provenance.size()) << name;
  }
}

TEST(ShippedFabrics, CallMeasuredOnlyWhatWasMeasured) {
  const auto measured = [](const std::string& name) {
    std::vector<std::string> keys;
    for (const auto& [key, provenance] : shipped(name).provenance) {
      if (provenance.kind == Provenance::Kind::kMeasured) keys.push_back(key);
    }
    return keys;
  };
  using Keys = std::vector<std::string>;
  const std::map<std::string, Keys> expected = {
      {"acrylic_knit", {"warp.elastic", "weft.elastic"}},
      {"cotton_knit", {"warp.elastic", "weft.elastic"}},
      {"cotton_poplin", {"areal_density", "bending", "bending.hysteresis"}},
      {"denim", {"areal_density"}},
      {"wool", {"areal_density", "shear.elastic", "warp.elastic", "weft.elastic"}},
      {"wool_tropical", {"areal_density", "bending", "bending.hysteresis"}}};
  for (const std::string& name : shippedNames()) {
    const auto found = expected.find(name);
    EXPECT_EQ(measured(name), found == expected.end() ? Keys{} : found->second) << name;
  }
}

TEST(ShippedFabrics, HaveAllThatContactNeeds) {
  for (const std::string& name : shippedNames()) {
    const Fabric fabric = shipped(name);
    ASSERT_TRUE(fabric.bending && fabric.compression && fabric.friction) << name;
    EXPECT_GT(fabric.compression->pressure.minimumSlope(), 0.0) << name;
  }
  // B = 0.067 gf.cm2/cm in the published table, 1 gf.cm2/cm = 9.80665e-5 N.m; stated to two digits.
  EXPECT_NEAR(shipped("wool").bending->weft, 0.067 * 9.80665e-5, 0.05e-6);
  // The other row of that table, stated to four digits: 12.38 mg/cm2 and B = 0.118 gf.cm2/cm.
  EXPECT_DOUBLE_EQ(shipped("cotton_poplin").areal_density, 0.01 * 12.38);
  EXPECT_NEAR(shipped("cotton_poplin").bending->warp, 0.118 * 9.80665e-5, 0.0005e-5);
  // 2HB of both rows: 0.033 and 0.124 gf.cm/cm, 1 gf.cm/cm = 9.80665e-3 N.
  EXPECT_NEAR(shipped("wool").bending_hysteresis->weft, 0.033 * 9.80665e-3, 0.05e-4);
  EXPECT_NEAR(shipped("cotton_poplin").bending_hysteresis->warp, 0.124 * 9.80665e-3, 0.0005e-3);
}

TEST(ShippedFabrics, HaveTheLinearityThatTheirSourcesState) {
  // LC = WC / (half of the pressure at Tm times the way), KES-FB3.
  const auto linearity = [](const std::string& name) {
    const YAML::Node kes =
        YAML::LoadFile((kFabrics / (name + ".yaml")).string())["compression"]["kes"];
    return kes["WC"].as<double>() /
           (0.5 * 4903.325 * (kes["T0"].as<double>() - kes["Tm"].as<double>()));
  };
  for (const std::string& name : shippedNames()) {
    if (name == "linear") continue;  // has points
    const bool knit = name == "acrylic_knit" || name == "cotton_knit";
    EXPECT_NEAR(linearity(name), knit ? 0.35 : 0.3, 0.005) << name;
  }
}

TEST(ShippedFabrics, SpanARoughnessOfOneToTwentyMicrometres) {
  std::vector<Surface> surfaces;
  for (const std::string& name : shippedNames()) {
    if (shipped(name).surface) surfaces.push_back(*shipped(name).surface);
  }
  ASSERT_EQ(surfaces.size(), 13u);
  std::sort(surfaces.begin(), surfaces.end(),
            [](const Surface& a, const Surface& b) { return a.roughness < b.roughness; });
  EXPECT_EQ(surfaces.front().roughness, 1e-6);
  EXPECT_EQ(surfaces.back().roughness, 20e-6);
  for (std::size_t i = 1; i < surfaces.size(); ++i) {
    // Distinct enough to be ranked, and without a gap; MMD rises alike, as the files say.
    const double ratio = surfaces[i].roughness / surfaces[i - 1].roughness;
    EXPECT_GT(ratio, 1.05) << surfaces[i].roughness;
    EXPECT_LT(ratio, 2.0) << surfaces[i].roughness;
    EXPECT_GT(surfaces[i].friction_deviation, surfaces[i - 1].friction_deviation);
  }
}

TEST(ShippedFabrics, AreWovenOrKnittedAndCanBeFelt) {
  std::set<std::string> knits;
  std::set<WeaveKind> kinds;
  for (const std::string& name : shippedNames()) {
    if (name == "linear") continue;  // of no textile
    ASSERT_TRUE(shipped(name).surface) << name;
    const auto relief = shipped(name).surface->relief;
    if (const Weave* weave = std::get_if<Weave>(&relief)) kinds.insert(weave->kind);
    if (std::holds_alternative<Knit>(relief)) knits.insert(name);
  }
  EXPECT_EQ(knits, (std::set<std::string>{"acrylic_knit", "cotton_knit"}));
  EXPECT_EQ(kinds, (std::set<WeaveKind>{WeaveKind::kPlain, WeaveKind::kTwill22, WeaveKind::kTwill31,
                                        WeaveKind::kSatin5, WeaveKind::kRib2}));
}

TEST(ShippedFabrics, HaveALookWithDenimDarkInWarpOnlyAndSatinTheGlossiest) {
  for (const std::string& name : shippedNames()) {
    const Fabric fabric = shipped(name);
    ASSERT_TRUE(fabric.look) << name;
    EXPECT_LE(fabric.look->gloss, shipped("polyester_satin").look->gloss) << name;
    const bool two_colours = fabric.look->warp != fabric.look->weft;
    EXPECT_EQ(two_colours, name == "denim") << name;
  }
  EXPECT_LT(shipped("denim").look->warp[0], 0.1 * shipped("denim").look->weft[0]);
}

TEST(ShippedFabrics, WoolPassesThroughEveryMeasuredPoint) {
  for (const auto& [direction, curve, points] : woolCurves()) {
    ASSERT_EQ(points.size(), 29u) << direction;
    for (const CurvePoint& point : points) {
      EXPECT_NEAR(curve.evaluate(point.strain).stress, point.stress, 1e-12 * std::abs(point.stress))
          << direction << " at " << point.strain;
    }
  }
}

TEST(ShippedFabrics, WoolHasTheEndsOfTheMeasurement) {
  // The last rows of the published table.
  const Fabric wool = shipped("wool");
  EXPECT_EQ(wool.areal_density, 0.15);
  EXPECT_NEAR(wool.weft.elastic.evaluate(0.114184).stress, 1052.1583, 1e-9);
  EXPECT_NEAR(wool.warp.elastic.evaluate(0.01361192).stress, 2998.0276, 1e-9);
  EXPECT_NEAR(wool.shear.elastic.evaluate(0.14).stress, 59.986, 1e-12);
}

TEST(ShippedFabrics, WoolRisesEverywhereAsItsDataDo) {
  for (const auto& [direction, curve, points] : woolCurves()) {
    EXPECT_GT(curve.minimumSlope(), 0.0) << direction;
    double before = curve.evaluate(points.front().strain - 0.01).stress;
    for (double strain = points.front().strain; strain < points.back().strain + 0.01;
         strain += 1e-5) {
      const double stress = curve.evaluate(strain).stress;
      ASSERT_GT(stress, before) << direction << " at " << strain;
      before = stress;
    }
  }
}

TEST(ShippedFabrics, WoolIsContinuouslyDifferentiableAtEveryKnot) {
  for (const auto& [direction, curve, points] : woolCurves()) {
    const double stress_scale = points.back().stress;
    const double slope_scale = curve.evaluate(curve.lastKnot()).slope;
    for (const CurvePoint& point : points) {
      const CurveValue below = curve.evaluate(std::nextafter(point.strain, -1.0));
      const CurveValue above = curve.evaluate(point.strain);
      EXPECT_NEAR(below.stress, above.stress, 1e-14 * stress_scale) << direction << point.strain;
      EXPECT_NEAR(below.slope, above.slope, 1e-13 * slope_scale) << direction << point.strain;
    }
  }
}

TEST(ShippedFabrics, WoolShearIsOdd) {
  const StrainStressCurve shear = shipped("wool").shear.elastic;
  for (double strain = 0.0; strain < 0.2; strain += 0.00131) {
    EXPECT_NEAR(shear.evaluate(-strain).stress, -shear.evaluate(strain).stress, 1e-12);
  }
}

TEST(ShippedFabrics, KnitsReturnTheForceThatTheTesterRecorded) {
  int checked = 0;
  for (const std::string name : {"acrylic_knit", "cotton_knit"}) {
    const Fabric fabric = shipped(name);
    for (const std::string direction : {"weft", "warp"}) {
      const auto& curve = (direction == "weft" ? fabric.weft : fabric.warp).elastic;
      for (const auto& [strain, force] : pointsInFile(name, direction)) {
        const double green = greenStrain(strain);
        EXPECT_NEAR(forcePerWidth(curve.evaluate(green).stress, green), force, 1e-12 * force)
            << name << ' ' << direction << " at " << strain;
        ++checked;
      }
    }
  }
  EXPECT_EQ(checked, 26 + 14 + 30 + 11);  // loading rows of the tests
}

TEST(ShippedFabrics, LinearReferenceIsIsotropic) {
  // The energy of a strain must not depend on the angle between fabric and strain.
  const Fabric linear = shipped("linear");
  EXPECT_EQ(linear.areal_density, 0.1);
  EXPECT_EQ(linear.weft.elastic.evaluate(0.0).slope, 100.0);
  const double uu = 0.07, vv = -0.02, uv = 0.03;  // tensor components
  const auto energy = [&](double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    const double turned_uu = c * c * uu + 2 * c * s * uv + s * s * vv;
    const double turned_vv = s * s * uu - 2 * c * s * uv + c * c * vv;
    const double turned_uv = (c * c - s * s) * uv + c * s * (vv - uu);
    return linear.weft.elastic.energy(turned_uu) + linear.warp.elastic.energy(turned_vv) +
           linear.shear.elastic.energy(2 * turned_uv);
  };
  for (double angle = 0.1; angle < 3.2; angle += 0.1) {
    EXPECT_NEAR(energy(angle), energy(0.0), 1e-14) << angle;
  }
}

TEST(ShippedFabrics, ViscosityIsAHundredthOfASecondTimesTheInitialSlope) {
  for (const std::string& name : shippedNames()) {
    if (name == "linear") continue;  // an exact reference, without viscosity
    const Fabric fabric = shipped(name);
    for (const MembraneCurves* curves : {&fabric.weft, &fabric.warp, &fabric.shear}) {
      // Stated values are rounded to two digits.
      EXPECT_NEAR(curves->viscous.evaluate(0.0).slope, 0.01 * curves->elastic.evaluate(0.0).slope,
                  0.03 * curves->viscous.evaluate(0.0).slope)
          << name;
    }
  }
  const Fabric linear = shipped("linear");
  EXPECT_TRUE(linear.weft.viscous.isZero() && linear.warp.viscous.isZero() &&
              linear.shear.viscous.isZero());
}

}  // namespace
}  // namespace haptex::material::test_shipped_fabrics
