#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "../refusal.h"
#include "haptex/material/compression.h"
#include "haptex/material/fabric_file.h"
#include "haptex/material/glued_layers.h"

namespace haptex::material::test_glued_layers {
namespace {

namespace fs = std::filesystem;

Fabric shipped(const std::string& name) {
  return loadFabric(std::string(HAPTEX_CONFIG_DIRECTORY) + "/fabrics/" + name + ".yaml");
}

/// Of a modulus (N/m) and a thickness (m), without bending of its own.
Fabric plate(double modulus, double thickness) {
  Fabric fabric;
  fabric.name = "plate";
  fabric.areal_density = 0.5;
  for (MembraneCurves* curves : {&fabric.weft, &fabric.warp, &fabric.shear}) {
    curves->elastic = StrainStressCurve::linear(modulus);
  }
  fabric.bending = BendingRigidity{0.0, 0.0};
  fabric.compression = compressionFromPoints({{0.0, thickness}, {1e4, 0.9 * thickness}});
  return fabric;
}

TEST(GluedLayers, AddTheirCurvesAtEveryStrain) {
  const std::vector<Fabric> layers{shipped("wool"), shipped("denim"), shipped("silk_habutae")};
  const Fabric glued = glue(layers, "three");
  EXPECT_EQ(glued.name, "three");
  for (double strain = -0.1; strain < 0.3; strain += 0.0037) {
    for (const auto direction : {&Fabric::weft, &Fabric::warp, &Fabric::shear}) {
      double stress = 0.0, slope = 0.0, viscous = 0.0;
      for (const Fabric& layer : layers) {
        stress += (layer.*direction).elastic.evaluate(strain).stress;
        slope += (layer.*direction).elastic.evaluate(strain).slope;
        viscous += (layer.*direction).viscous.evaluate(strain).stress;
      }
      const CurveValue sum = (glued.*direction).elastic.evaluate(strain);
      EXPECT_NEAR(sum.stress, stress, 1e-9 * std::abs(stress) + 1e-12);
      EXPECT_NEAR(sum.slope, slope, 1e-8 * std::abs(slope));
      EXPECT_NEAR((glued.*direction).viscous.evaluate(strain).stress, viscous,
                  1e-9 * std::abs(viscous) + 1e-12);
    }
  }
  EXPECT_DOUBLE_EQ(glued.areal_density,
                   layers[0].areal_density + layers[1].areal_density + layers[2].areal_density);
}

TEST(GluedLayers, OfOneHomogeneousPlateBendAsItLessWhatEachBendsByItself) {
  // n layers of E t / n each, t / n thick: sum k (z - z0)^2 = E t^3 / 12 (1 - 1 / n^2).
  constexpr double kModulus = 1e6, kThickness = 2e-3;  // N/m, of all; m
  const double whole = kModulus * kThickness * kThickness / 12.0;
  for (const int n : {2, 3, 8}) {
    const Fabric glued = glue(std::vector<Fabric>(n, plate(kModulus / n, kThickness / n)), "stack");
    EXPECT_NEAR(glued.bending->weft, whole * (1.0 - 1.0 / (n * n)), 1e-12 * whole);
    EXPECT_NEAR(glued.compression->thickness, kThickness, 1e-15);
  }
}

TEST(GluedLayers, BendAboutTheirOwnNeutralPlane) {
  // k1 k2 / (k1 + k2) d^2 for two layers whose middles are d apart.
  const Fabric glued = glue({plate(3e4, 1e-3), plate(1e4, 3e-3)}, "two");
  EXPECT_NEAR(glued.bending->warp, 3e4 * 1e4 / 4e4 * 2e-3 * 2e-3, 1e-12);
}

TEST(GluedLayers, AreAsThickUnderPressureAsAllOfThem) {
  const std::vector<Fabric> layers{shipped("wool"), shipped("denim")};
  const Fabric glued = glue(layers, "two");
  for (const double pressure : {49.03325, 4903.325}) {
    double thickness = 0.0;
    for (const Fabric& layer : layers) {
      const Compression& own = *layer.compression;
      double low = 0.0, high = 1.0;
      for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (own.pressure.evaluate(middle).stress < pressure ? low : high) = middle;
      }
      thickness += own.thickness * (1.0 - low);
    }
    const double strain = 1.0 - thickness / glued.compression->thickness;
    EXPECT_NEAR(glued.compression->pressure.evaluate(strain).stress, pressure, 0.02 * pressure);
  }
}

TEST(GluedLayers, AreFeltOnTheFirstAndNeverCalledMeasured) {
  const Fabric wool = shipped("wool"), denim = shipped("denim");
  const Fabric glued = glue({denim, wool}, "two");
  EXPECT_EQ(glued.friction, denim.friction);
  EXPECT_EQ(glued.surface.has_value(), denim.surface.has_value());
  EXPECT_EQ(glued.provenance.at("warp.elastic").kind, Provenance::Kind::kRepresentative);
  EXPECT_FALSE(glued.resilience);
  EXPECT_FALSE(glued.contraction);
}

TEST(GluedLayers, NeedWhatBendsThem) {
  Fabric bare = shipped("wool");
  bare.compression.reset();
  try {
    glue({shipped("denim"), bare}, "two");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("layer wool has no compression"), std::string::npos);
  }
  EXPECT_THROW(glue({shipped("wool")}, "one"), std::invalid_argument);
  EXPECT_THROW(glue(std::vector<Fabric>(9, shipped("wool")), "nine"), std::invalid_argument);
}

class GluedFile : public testing::Test {
 protected:
  GluedFile()
      : directory_(fs::path(testing::TempDir()) / ("haptex_glued_" + std::to_string(getpid()))) {
    fs::create_directories(directory_);
    for (const char* name : {"wool.yaml", "denim.yaml"}) {
      fs::copy_file(fs::path(HAPTEX_CONFIG_DIRECTORY) / "fabrics" / name, directory_ / name,
                    fs::copy_options::overwrite_existing);
    }
  }
  ~GluedFile() override { fs::remove_all(directory_); }

  Fabric load(const std::string& layers) const {
    const fs::path path = directory_ / "glued.yaml";
    std::ofstream(path) << "name: glued\nlayers: " << layers << "\n";
    return loadFabric(path.string());
  }
  std::string refusalOf(const std::string& layers) const {
    return test::refusalOf([&] { load(layers); });
  }

  fs::path directory_;
};

TEST_F(GluedFile, IsOneFabricOfItsLayersAlsoWhereTheirFilesAreNot) {
  const Fabric glued = load("[wool.yaml, denim.yaml]");
  EXPECT_EQ(glued.name, "glued");
  const Fabric exact = glue({shipped("wool"), shipped("denim")}, "glued");
  EXPECT_EQ(glued.bending->weft, exact.bending->weft);
  const Fabric elsewhere = parseFabric(glued.file, "/nowhere/glued.yaml");
  EXPECT_EQ(elsewhere.bending->weft, exact.bending->weft);
  EXPECT_EQ(elsewhere.weft.elastic.evaluate(0.02).stress, exact.weft.elastic.evaluate(0.02).stress);
  EXPECT_EQ(elsewhere.file, parseFabric(elsewhere.file, "/nowhere/glued.yaml").file);
}

TEST_F(GluedFile, RefusalsNameTheLayer) {
  EXPECT_NE(refusalOf("[wool.yaml]").find("layers: there are 1 layers: allowed are 2 to 8"),
            std::string::npos);
  EXPECT_NE(refusalOf("[wool.yaml, silk.yaml]").find("layers[1]"), std::string::npos);
  EXPECT_NE(refusalOf("[wool.yaml, {name: bare}]").find("layers[1]"), std::string::npos);
  std::ofstream(directory_ / "again.yaml") << "name: again\nlayers: [again.yaml, wool.yaml]\n";
  EXPECT_NE(refusalOf("[wool.yaml, again.yaml]").find("layers[1]"), std::string::npos);
}

}  // namespace
}  // namespace haptex::material::test_glued_layers
