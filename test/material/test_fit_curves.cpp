// Readings become a fabric file, and the file says what was read.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "haptex/base/constants.h"
#include "haptex/material/fabric_file.h"
#include "haptex/material/fit_curves.h"
#include "tester_readings.h"

namespace haptex::material::test_fit_curves {
namespace {

class File {
 public:
  File(const std::string& name, const std::string& text)
      : path_(testing::TempDir() + "haptex_" + std::to_string(getpid()) + "_" + name) {
    std::ofstream(path_) << text;
  }
  ~File() { std::remove(path_.c_str()); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

struct Outcome {
  int status;
  std::string yaml, notes;

  Fabric fabric() const { return loadFabric(File("fabric.yaml", yaml).path()); }
};

Outcome run(const std::vector<std::string>& arguments) {
  std::ostringstream out, notes;
  const int status = fitCurves(arguments, out, notes);
  return {status, out.str(), notes.str()};
}

Outcome fitText(const std::string& text, const std::string& pieces = "8") {
  const File file("readings.csv", text);
  return run({file.path(), "--pieces", pieces, "--name", "sample"});
}

Fabric shipped(const std::string& name) {
  return loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/" + name + ".yaml");
}

/// The largest difference from 0 to a strain, of the largest stress.
double difference(const StrainStressCurve& a, const StrainStressCurve& b, double most) {
  double largest = 0.0;
  for (int i = 0; i <= 100; ++i) {
    const double strain = most * i / 100;
    largest = std::max(largest, std::abs(a.evaluate(strain).stress - b.evaluate(strain).stress));
  }
  return largest / std::abs(b.evaluate(most).stress);
}

double pressureDifference(const Compression& a, const Compression& b) {
  const auto pressure = [](const Compression& of, double thickness) {
    return of.pressure.evaluate(1.0 - thickness / of.thickness).stress;
  };
  double largest = 0.0;
  for (double t = 3.1e-4; t < 4.1e-4; t += 1e-6) {
    largest = std::max(largest, std::abs(pressure(a, t) / pressure(b, t) - 1.0));
  }
  return largest;
}

void expectHysteresisOf(const Fabric& exact, const Fabric& fitted, double share) {
  const auto near = [&](double value, double expected) {
    EXPECT_NEAR(value, expected, share * expected);
  };
  near(fitted.resilience->weft, exact.resilience->weft);
  near(fitted.resilience->warp, exact.resilience->warp);
  near(fitted.shear_hysteresis->at_half_degree, exact.shear_hysteresis->at_half_degree);
  near(fitted.shear_hysteresis->at_five_degrees, exact.shear_hysteresis->at_five_degrees);
  near(fitted.bending->weft, exact.bending->weft);
  near(fitted.bending->warp, exact.bending->warp);
  near(fitted.bending_hysteresis->weft, exact.bending_hysteresis->weft);
  near(fitted.bending_hysteresis->warp, exact.bending_hysteresis->warp);
  near(*fitted.friction, *exact.friction);
  near(fitted.areal_density, exact.areal_density);
}

// Wool's curves have corners at 29 points; 14 pieces follow them, more would need more readings.
TEST(FitCurves, GivesBackTheFabricWhoseLoopsWereRead) {
  const Fabric wool = shipped("wool");
  const Outcome outcome = fitText(VirtualReadings(wool).text(), "14");
  ASSERT_EQ(outcome.status, 0) << outcome.notes;
  const Fabric fitted = outcome.fabric();
  EXPECT_EQ(fitted.name, "sample");
  EXPECT_LT(difference(fitted.weft.elastic, wool.weft.elastic, 0.085), 0.005);
  EXPECT_LT(difference(fitted.warp.elastic, wool.warp.elastic, 0.0079), 0.005);
  EXPECT_LT(difference(fitted.shear.elastic, wool.shear.elastic, 0.139), 0.005);
  EXPECT_LT(pressureDifference(*fitted.compression, *wool.compression), 0.01);
  expectHysteresisOf(wool, fitted, 0.02);
  for (const auto& [key, provenance] : fitted.provenance) {
    EXPECT_EQ(provenance.kind, Provenance::Kind::kMeasured) << key;
    EXPECT_NE(provenance.source.find("readings.csv"), std::string::npos) << key;
  }
  // sqrt(p / pm) of the pressure comes back; what KES calls RC has no key.
  EXPECT_NE(outcome.yaml.find("# Resilience of compression RC 60."), std::string::npos);
  EXPECT_NE(outcome.notes.find("parameter\tRC\t%\t60."), std::string::npos);
  EXPECT_NE(outcome.notes.find("fit\ttensile/weft\t81\t14\t"), std::string::npos);
}

TEST(FitCurves, SmoothsNoisyLoops) {
  const Fabric wool = shipped("wool");
  const Outcome outcome = fitText(VirtualReadings(wool, 0.01).text());
  ASSERT_EQ(outcome.status, 0) << outcome.notes;
  const Fabric fitted = outcome.fabric();
  EXPECT_LT(difference(fitted.weft.elastic, wool.weft.elastic, 0.085), 0.02);
  EXPECT_LT(difference(fitted.warp.elastic, wool.warp.elastic, 0.0079), 0.02);
  EXPECT_LT(difference(fitted.shear.elastic, wool.shear.elastic, 0.139), 0.02);
  EXPECT_GE(fitted.weft.elastic.minimumSlope(), -1e-6);
  EXPECT_NEAR(fitted.resilience->weft, 0.65, 0.02);
  EXPECT_NEAR(fitted.shear_hysteresis->at_five_degrees, 4.0, 0.2);
  EXPECT_NEAR(fitted.bending_hysteresis->weft, 3.2e-4, 2e-5);
}

TEST(FitCurves, ReadsTheShippedExample) {
  const Outcome outcome = run({HAPTEX_CONFIG_DIRECTORY "/readings/wool_readings.csv"});
  ASSERT_EQ(outcome.status, 0) << outcome.notes;
  const Fabric fitted = outcome.fabric(), wool = shipped("wool");
  EXPECT_EQ(fitted.name, "wool_readings");
  EXPECT_LT(difference(fitted.weft.elastic, wool.weft.elastic, 0.085), 0.02);
  EXPECT_LT(difference(fitted.shear.elastic, wool.shear.elastic, 0.139), 0.02);
  expectHysteresisOf(wool, fitted, 0.1);  // 2HG is but three times the noise of shear
  for (const auto& [key, provenance] : fitted.provenance) {
    EXPECT_EQ(provenance.kind, Provenance::Kind::kRepresentative) << key;
  }
}

const std::string kHead = "test,direction,branch,x,y\n";
const std::string kFast =
    "value,,W,200,g/m2\n"
    "value,weft,E5,1.0,%\nvalue,weft,E20,2.2,%\nvalue,weft,E100,4.6,%\n"
    "value,warp,E5,0.6,%\nvalue,warp,E20,1.3,%\nvalue,warp,E100,2.5,%\n"
    "value,,EB5,2.5,%\nvalue,weft,C,16.0,mm\nvalue,warp,C,18.0,mm\n"
    "value,,T2,0.62,mm\nvalue,,T100,0.44,mm\n";

// De Boos and Tester 1994: loads of 4.9, 19.6 and 98.1 N/m; B = 9.807e-6 W C^3 uN.m with W in g/m2
// and C in mm; G = 123 / EB5 N/m with EB5 in percent.
TEST(FitCurves, GivesBackFastValues) {
  const Outcome outcome = fitText(kHead + kFast);
  ASSERT_EQ(outcome.status, 0) << outcome.notes;
  const Fabric fabric = outcome.fabric();
  const auto load = [](const MembraneCurves& curves, double extension) {
    return (1.0 + extension) * curves.elastic.evaluate(greenStrain(extension)).stress;
  };
  EXPECT_NEAR(load(fabric.weft, 0.010), 4.903325, 1e-6);
  EXPECT_NEAR(load(fabric.weft, 0.022), 19.6133, 1e-6);
  EXPECT_NEAR(load(fabric.weft, 0.046), 98.0665, 1e-6);
  EXPECT_NEAR(load(fabric.warp, 0.025), 98.0665, 1e-6);
  EXPECT_NEAR(fabric.bending->weft, 9.80665e-12 * 200.0 * 16.0 * 16.0 * 16.0, 1e-12);
  EXPECT_NEAR(fabric.bending->warp, 9.80665e-12 * 200.0 * 18.0 * 18.0 * 18.0, 1e-12);
  EXPECT_NEAR(fabric.shear.elastic.evaluate(0.05).stress, 0.05 * 123.0 / 2.5, 1e-9);
  const auto pressure = [&](double thickness) {
    return fabric.compression->pressure.evaluate(1.0 - thickness / fabric.compression->thickness)
        .stress;
  };
  EXPECT_NEAR(pressure(0.62e-3), 196.133, 1e-3 * 196.133);
  EXPECT_NEAR(pressure(0.44e-3), 9806.65, 1e-3 * 9806.65);
}

// EMT, LT, WT: 2 WT = LT Fm EMT.
TEST(FitCurves, GivesBackKesValues) {
  const Outcome outcome = fitText(
      kHead +
      "value,,W,16.3,mg/cm2\nvalue,weft,EMT,5.1,%\nvalue,weft,LT,0.58,1\n"
      "value,warp,EMT,3.2,%\nvalue,warp,WT,5.6,gf.cm/cm2\nvalue,,RT,62,%\nvalue,weft,G,0.70,gf/"
      "(cm.deg)\n"
      "value,warp,G,0.80,gf/(cm.deg)\nvalue,,2HG,0.9,gf/cm\nvalue,,2HG5,2.1,gf/cm\n"
      "value,,B,0.067,gf.cm2/cm\nvalue,,2HB,0.033,gf.cm/cm\nvalue,,T0,0.41,mm\nvalue,,TM,0.31,mm\n"
      "value,,LC,0.3,1\nvalue,,RC,55,%\nvalue,,MIU,0.19,1\nvalue,,SMD,4.1,um\n");
  ASSERT_EQ(outcome.status, 0) << outcome.notes;
  const Fabric fabric = outcome.fabric();
  const auto work = [](const MembraneCurves& curves, double extension) {
    return curves.elastic.energy(greenStrain(extension));
  };
  EXPECT_NEAR(work(fabric.weft, 0.051), 0.58 * 0.5 * kKesTensileLoad * 0.051, 2e-3 * 7.25);
  EXPECT_NEAR(work(fabric.warp, 0.032), 5.6 * kKesGramPerCentimetre, 2e-3 * 5.5);
  EXPECT_NEAR(1.051 * fabric.weft.elastic.evaluate(greenStrain(0.051)).stress, kKesTensileLoad,
              1e-6);
  EXPECT_GT(fabric.weft.elastic.evaluate(0.0).slope, 100.0);
  EXPECT_NEAR(fabric.shear.elastic.evaluate(0.1).stress, 0.1 * 0.75 * 56.19, 1e-3);
  EXPECT_NEAR(fabric.resilience->warp, 0.62, 1e-12);
  EXPECT_NEAR(fabric.shear_hysteresis->at_five_degrees, 2.1 * kKesGramPerCentimetre, 1e-12);
  EXPECT_NEAR(fabric.bending->weft, 0.067 * 9.80665e-5, 1e-15);
  EXPECT_NEAR(fabric.bending_hysteresis->warp, 0.033 * 9.80665e-3, 1e-15);
  EXPECT_NEAR(*fabric.friction, 0.19, 1e-12);
  EXPECT_NE(outcome.yaml.find("RC 55 %"), std::string::npos);
  EXPECT_NE(outcome.yaml.find("SMD 4.1e-06 m"), std::string::npos);
}

TEST(FitCurves, ReadsForcesInNewtonAndTheMeanFriction) {
  std::string text =
      "# width: 50 mm\n# units: tensile 1 N\n# units: surface mm 1\n" + kHead + kFast;
  for (const std::string direction : {"weft", "warp"}) {
    for (int i = 1; i <= 30; ++i) {
      text += "tensile," + direction + ",loading," + std::to_string(0.001 * i) + "," +
              std::to_string(0.5 * i) + "\n";
    }
  }
  text += "surface,,loading,1,0.2\nsurface,,loading,2,0.3\nsurface,,unloading,1,-0.25\n";
  const Outcome outcome = fitText(text);
  ASSERT_EQ(outcome.status, 0) << outcome.notes;
  const Fabric fabric = outcome.fabric();
  EXPECT_NEAR(1.02 * fabric.weft.elastic.evaluate(greenStrain(0.02)).stress, 10.0 / 0.05, 0.05);
  EXPECT_NEAR(*fabric.friction, 0.25, 1e-12);
}

TEST(FitCurves, ChecksItsArguments) {
  EXPECT_EQ(run({"--help"}).status, 0);
  const auto refused = [](const std::vector<std::string>& arguments, const std::string& why) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.yaml, "");
    EXPECT_EQ(outcome.notes.substr(0, outcome.notes.find('\n')), "fit_curves: " + why);
  };
  refused({}, "the file of readings is missing");
  refused({"a.csv", "b.csv"}, "b.csv: one file of readings is allowed, a.csv is there");
  refused({"a.csv", "--pieces"}, "--pieces needs a value");
  refused({"a.csv", "--pieces", "0"}, "--pieces 0: allowed are whole numbers from 1 to 100");
  refused({"a.csv", "--pieces", "3.5"}, "--pieces 3.5: allowed are whole numbers from 1 to 100");
  refused({"a.csv", "--peaces", "3"}, "--peaces is unknown; allowed are --pieces and --name");
  const Outcome missing = run({"/nowhere/a.csv"});
  EXPECT_EQ(missing.status, 1);
  EXPECT_EQ(missing.notes, "fit_curves: /nowhere/a.csv: cannot be read\n");
}

}  // namespace
}  // namespace haptex::material::test_fit_curves
