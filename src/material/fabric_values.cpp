#include "haptex/material/fabric_values.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "haptex/base/yaml_reader.h"
#include "haptex/material/compression.h"
#include "haptex/material/contraction.h"
#include "haptex/material/strain_measures.h"
#include "haptex/material/surface_file.h"

namespace haptex::material {
namespace {

constexpr const char* kPiolaOverGreen = "second_piola_kirchhoff_over_green_lagrange";
constexpr const char* kForceOverEngineering = "force_per_width_over_engineering_strain";

enum class CurveKind { kElastic, kViscous };

// What the place of a curve in the file asks of it.
struct CurveRules {
  CurveKind kind;
  NegativeBranch negative_branch;
  bool from_tester;  // may state force per width over engineering strain
};

Provenance readProvenance(const base::YamlValue& value) {
  const bool measured = value.at("provenance").oneOf({"measured", "representative"}) == "measured";
  return {measured ? Provenance::Kind::kMeasured : Provenance::Kind::kRepresentative,
          value.at("source").text()};
}

// Runs `make` and gives what it refuses the file and key of `value`.
template <typename Make>
auto namingKey(const base::YamlValue& value, Make make) {
  try {
    return make();
  } catch (const std::invalid_argument& error) {
    const std::string message = error.what();
    const bool starts_with_key = message.find(": ") != std::string::npos;
    throw std::invalid_argument(value.file() + ": " + value.keyPath() +
                                (starts_with_key ? "." : ": ") + message);
  }
}

double readModulus(const base::YamlValue& value) {
  const double modulus = value.number();
  if (modulus < 0.0) value.refuse("must be a finite number >= 0");
  return modulus;
}

std::vector<CurvePoint> readPoints(const base::YamlValue& value) {
  std::vector<CurvePoint> points;
  for (const base::YamlValue& item : value.items()) {
    const std::vector<base::YamlValue> pair = item.items(2);
    points.push_back({pair[0].number(), pair[1].number()});
  }
  return points;
}

// With stress 0 at rate 0, a curve that nowhere falls has the sign of the rate: it takes energy
// out.
void requireDissipative(const base::YamlValue& value, const std::vector<CurvePoint>& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double before = i > 0 ? points[i - 1].stress : points[0].stress;
    const bool wrong_sign = points[i].stress * points[i].strain < 0.0;
    if (points[i].stress < before || wrong_sign) {
      value.at("points").items()[i].items()[1].refuse(
          "must have the sign of the rate and not be less than the stress before: a viscous curve "
          "must dissipate");
    }
  }
}

// An elastic stress against its strain would do work on the cloth without end.
void requireRestoring(const base::YamlValue& value, const std::vector<CurvePoint>& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].stress * points[i].strain < 0.0) {
      value.at("points").items()[i].items()[1].refuse(
          "must have the sign of the strain: an elastic curve must pull back");
    }
  }
}

// The curve goes on with its outermost slopes, so a fall there would have no end either.
void requireRisingEnds(const base::YamlValue& value, const StrainStressCurve& curve) {
  for (const double knot : {curve.firstKnot(), curve.lastKnot()}) {
    const double slope = curve.evaluate(knot).slope;
    if (slope < 0.0) {
      value.refuseBecause("the curve ends at " + std::to_string(knot) + " with the slope " +
                          std::to_string(slope) + ", it must be >= 0: the curve continues with it");
    }
  }
}

// Of a thread direction: no stretch has a smaller Green-Lagrange strain than none.
void requirePossibleStrains(const base::YamlValue& value, const std::vector<CurvePoint>& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].strain < -0.5) {
      value.at("points").items()[i].items()[0].refuse(
          "must be >= -0.5, the Green-Lagrange strain of collapse");
    }
  }
}

StrainStressCurve readPointCurve(const base::YamlValue& value, const CurveRules& rules) {
  const std::string quantity =
      rules.from_tester ? value.at("quantity").oneOf({kPiolaOverGreen, kForceOverEngineering})
                        : value.at("quantity").oneOf({kPiolaOverGreen});
  std::vector<CurvePoint> points = readPoints(value.at("points"));
  // Before the conversion, so that a message has the numbers as written.
  namingKey(value, [&] { requireFitPoints(points); });
  if (rules.kind == CurveKind::kViscous) {
    requireDissipative(value, points);
  } else {
    requireRestoring(value, points);
    if (rules.from_tester && quantity == kPiolaOverGreen) requirePossibleStrains(value, points);
  }
  const StrainStressCurve curve = namingKey(value, [&] {
    if (quantity == kForceOverEngineering) points = curvePointsFromTester(points);
    return StrainStressCurve::fit(points, rules.negative_branch);
  });
  requireRisingEnds(value, curve);
  return curve;
}

// More than rounding in a curve that is level somewhere does.
bool falls(const StrainStressCurve& curve, const std::vector<double>& knots) {
  double largest_slope = 0.0;
  for (const double knot : knots) {
    largest_slope = std::max(largest_slope, std::abs(curve.evaluate(knot).slope));
  }
  return curve.minimumSlope() < -StrainStressCurve::kJumpTolerance * largest_slope;
}

StrainStressCurve readPolynomialCurve(const base::YamlValue& value, CurveKind kind) {
  value.requireKeys({"knots", "coefficients"});
  std::vector<double> knots;
  for (const base::YamlValue& knot : value.at("knots").items()) knots.push_back(knot.number());
  std::vector<std::array<double, 4>> coefficients;
  for (const base::YamlValue& row : value.at("coefficients").items()) {
    const std::vector<base::YamlValue> numbers = row.items(4);
    coefficients.push_back(
        {numbers[0].number(), numbers[1].number(), numbers[2].number(), numbers[3].number()});
  }
  const auto curve =
      namingKey(value, [&] { return StrainStressCurve::fromPolynomials(knots, coefficients); });
  if (kind == CurveKind::kViscous && falls(curve, knots)) {
    value.refuseBecause("the slope falls to " + std::to_string(curve.minimumSlope()) +
                        ", it must be >= 0 everywhere: a viscous curve must dissipate");
  }
  requireRisingEnds(value, curve);
  return curve;
}

StrainStressCurve readCurve(const base::YamlValue& value, const CurveRules& rules) {
  value.requireKeys({"unit", "provenance", "source"},
                    {"modulus", "points", "polynomials", "quantity"});
  value.at("unit").oneOf({rules.kind == CurveKind::kElastic ? "N/m" : "N.s/m"});
  const bool has_points = value.has("points");
  if (value.has("modulus") + has_points + value.has("polynomials") != 1) {
    value.refuseBecause("must have exactly one of modulus, points, polynomials");
  }
  if (value.has("quantity") && !has_points) {
    value.at("quantity").refuseBecause("is allowed only together with points");
  }
  if (has_points && !value.has("quantity")) {
    value.refuseBecause("the key 'quantity' is missing, required together with points");
  }
  if (has_points) return readPointCurve(value, rules);
  if (value.has("modulus")) return StrainStressCurve::linear(readModulus(value.at("modulus")));
  return readPolynomialCurve(value.at("polynomials"), rules.kind);
}

double readArealDensity(const base::YamlValue& value) {
  value.requireKeys({"value", "unit", "provenance", "source"});
  value.at("unit").oneOf({"kg/m2"});
  const double density = value.at("value").number();
  if (density <= 0.0) value.at("value").refuse("must be a finite number > 0");
  return density;
}

double readRigidity(const base::YamlValue& value) {
  const double rigidity = value.number();
  if (rigidity < 0.0) value.refuse("must be a finite number >= 0");
  return rigidity;
}

BendingRigidity readBending(const base::YamlValue& value) {
  value.requireKeys({"unit", "provenance", "source", "weft", "warp"}, {"hysteresis"});
  value.at("unit").oneOf({"N.m"});
  return {readRigidity(value.at("weft")), readRigidity(value.at("warp"))};
}

double readLoopWidth(const base::YamlValue& value) {
  const double width = value.number();
  if (width < 0.0) value.refuse("must be a finite number >= 0");
  return width;
}

double readLoopWidth(const base::YamlValue& value, double rigidity) {
  const double width = readLoopWidth(value);
  if (width > 0.0 && rigidity == 0.0) value.refuse("must be 0, as the rigidity is");
  return width;
}

BendingHysteresis readHysteresis(const base::YamlValue& value, const BendingRigidity& rigidity) {
  value.requireKeys({"unit", "provenance", "source", "weft", "warp"});
  value.at("unit").oneOf({"N"});
  return {readLoopWidth(value.at("weft"), rigidity.weft),
          readLoopWidth(value.at("warp"), rigidity.warp)};
}

// Reads the bending, if there is one, and the provenance of its hysteresis into the fabric.
void readBendingInto(const base::YamlValue& file, Fabric& fabric) {
  if (!file.has("bending")) return;
  const base::YamlValue value = file.at("bending");
  fabric.bending = readBending(value);
  if (!value.has("hysteresis")) return;
  fabric.bending_hysteresis = readHysteresis(value.at("hysteresis"), *fabric.bending);
  fabric.provenance["bending.hysteresis"] = readProvenance(value.at("hysteresis"));
}

ShearHysteresis readShearHysteresis(const base::YamlValue& value) {
  value.requireKeys({"unit", "provenance", "source", "2HG", "2HG5"});
  value.at("unit").oneOf({"N/m"});
  return {readLoopWidth(value.at("2HG")), readLoopWidth(value.at("2HG5"))};
}

double readResilience(const base::YamlValue& value) {
  const double resilience = value.number();
  if (resilience < TensileResilience::kLeast || resilience > 1.0) {
    value.refuse("must be a number from 0.1 to 1, KES RT over 100");
  }
  return resilience;
}

TensileResilience readResiliences(const base::YamlValue& value) {
  value.requireKeys({"provenance", "source", "weft", "warp"});
  return {readResilience(value.at("weft")), readResilience(value.at("warp"))};
}

/// Of a fabric whose curves are read.
double readContraction(const base::YamlValue& value, const Fabric& fabric) {
  value.requireKeys({"value", "provenance", "source"});
  const double contraction = value.at("value").number();
  const double largest = largestContraction(fabric);
  if (contraction < 0.0 || contraction >= largest) {
    value.at("value").refuse("must be >= 0 and < " + std::to_string(largest) +
                             ": at more weft and warp of these curves would give way together");
  }
  return contraction;
}

std::vector<ThicknessPoint> readThicknessPoints(const base::YamlValue& value) {
  std::vector<ThicknessPoint> points;
  for (const base::YamlValue& item : value.items()) {
    const std::vector<base::YamlValue> pair = item.items(2);
    points.push_back({pair[0].number(), pair[1].number()});
  }
  return points;
}

Compression readCompression(const base::YamlValue& value) {
  value.requireKeys({"unit", "provenance", "source"}, {"points", "kes"});
  if (value.has("points") == value.has("kes")) {
    value.refuseBecause("must have exactly one of points, kes");
  }
  if (value.has("points")) {
    value.at("unit").oneOf({"Pa and m"});
    const std::vector<ThicknessPoint> points = readThicknessPoints(value.at("points"));
    return namingKey(value, [&] { return compressionFromPoints(points); });
  }
  value.at("unit").oneOf({"m and J/m2"});
  const base::YamlValue kes = value.at("kes");
  kes.requireKeys({"T0", "Tm", "WC"});
  const KesCompression numbers{kes.at("T0").number(), kes.at("Tm").number(), kes.at("WC").number()};
  return namingKey(kes, [&] { return compressionFromKes(numbers); });
}

double readFriction(const base::YamlValue& value) {
  value.requireKeys({"value", "provenance", "source"});
  const double friction = value.at("value").number();
  if (friction <= 0.0) value.at("value").refuse("must be a finite number > 0");
  return friction;
}

// Reads the curves of the direction `key` and their provenance into the fabric.
MembraneCurves readDirection(const base::YamlValue& fabric_value, const std::string& key,
                             NegativeBranch negative_branch, Fabric& fabric) {
  const base::YamlValue value = fabric_value.at(key);
  const bool thread_direction = negative_branch == NegativeBranch::kLinear;
  if (thread_direction) {
    value.requireKeys({"elastic"}, {"viscous"});
  } else {
    value.requireKeys({"elastic"}, {"viscous", "hysteresis"});
  }
  MembraneCurves curves;
  curves.elastic =
      readCurve(value.at("elastic"), {CurveKind::kElastic, negative_branch, thread_direction});
  fabric.provenance[key + ".elastic"] = readProvenance(value.at("elastic"));
  if (value.has("viscous")) {
    curves.viscous = readCurve(value.at("viscous"), {CurveKind::kViscous, negative_branch, false});
    fabric.provenance[key + ".viscous"] = readProvenance(value.at("viscous"));
  }
  return curves;
}

// Reads the shear, and the provenance of all that it has, into the fabric.
void readShearInto(const base::YamlValue& file, Fabric& fabric) {
  fabric.shear = readDirection(file, "shear", NegativeBranch::kOdd, fabric);
  const base::YamlValue value = file.at("shear");
  if (!value.has("hysteresis")) return;
  fabric.shear_hysteresis = readShearHysteresis(value.at("hysteresis"));
  fabric.provenance["shear.hysteresis"] = readProvenance(value.at("hysteresis"));
}

// Reads the surface, if there is one, and its provenance into the fabric, after the friction.
void readSurfaceInto(const base::YamlValue& file, Fabric& fabric) {
  if (!file.has("surface")) return;
  if (!fabric.friction) {
    file.refuseBecause("the key 'friction' is missing, required together with surface");
  }
  const base::YamlValue value = file.at("surface");
  fabric.surface = readSurface(value, *fabric.friction);
  for (const std::string key : {"kes", "weave", "knit", "heights"}) {
    if (value.has(key)) fabric.provenance["surface." + key] = readProvenance(value.at(key));
  }
}

}  // namespace

Fabric readFabricValues(const base::YamlValue& file) {
  file.requireKeys({"name", "areal_density", "weft", "warp", "shear"},
                   {"description", "resilience", "bending", "contraction", "compression",
                    "friction", "surface", "look"});
  Fabric fabric;
  fabric.name = file.at("name").text();
  if (file.has("description")) fabric.description = file.at("description").text();
  fabric.areal_density = readArealDensity(file.at("areal_density"));
  fabric.provenance["areal_density"] = readProvenance(file.at("areal_density"));
  fabric.weft = readDirection(file, "weft", NegativeBranch::kLinear, fabric);
  fabric.warp = readDirection(file, "warp", NegativeBranch::kLinear, fabric);
  readShearInto(file, fabric);
  if (file.has("resilience")) fabric.resilience = readResiliences(file.at("resilience"));
  readBendingInto(file, fabric);
  if (file.has("contraction")) {
    fabric.contraction = readContraction(file.at("contraction"), fabric);
  }
  if (file.has("compression")) fabric.compression = readCompression(file.at("compression"));
  if (file.has("friction")) fabric.friction = readFriction(file.at("friction"));
  readSurfaceInto(file, fabric);
  if (file.has("look")) {
    const bool knitted = fabric.surface && std::holds_alternative<Knit>(fabric.surface->relief);
    fabric.look = readLook(file.at("look"), knitted);
  }
  for (const std::string key :
       {"resilience", "bending", "contraction", "compression", "friction", "look"}) {
    if (file.has(key)) fabric.provenance[key] = readProvenance(file.at(key));
  }
  return fabric;
}

}  // namespace haptex::material
