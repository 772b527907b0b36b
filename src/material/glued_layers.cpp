#include "haptex/material/glued_layers.h"

#include <algorithm>
#include <array>
#include <functional>

#include "haptex/base/require.h"
#include "haptex/material/compression.h"

namespace haptex::material {
namespace {

using Curve = StrainStressCurve MembraneCurves::*;
using Direction = MembraneCurves Fabric::*;
using CurveOf = std::function<const StrainStressCurve&(const Fabric&)>;

/// What a sum of cubics between the knots of all is there: a cubic with its values and slopes.
StrainStressCurve sumOf(const std::vector<Fabric>& layers, const CurveOf& curve) {
  std::vector<double> knots;
  for (const Fabric& layer : layers) {
    const std::vector<double>& own = curve(layer).knots();
    knots.insert(knots.end(), own.begin(), own.end());
  }
  std::sort(knots.begin(), knots.end());
  knots.erase(std::unique(knots.begin(), knots.end()), knots.end());
  std::vector<std::array<double, 4>> coefficients;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    CurveValue begin{0.0, 0.0}, end{0.0, 0.0};
    for (const Fabric& layer : layers) {
      const CurveValue first = curve(layer).evaluate(knots[i]);
      const CurveValue last = curve(layer).evaluate(knots[i + 1]);
      begin = {begin.stress + first.stress, begin.slope + first.slope};
      end = {end.stress + last.stress, end.slope + last.slope};
    }
    const double width = knots[i + 1] - knots[i];
    const double secant = (end.stress - begin.stress) / width;
    coefficients.push_back({begin.stress, begin.slope,
                            (3.0 * secant - 2.0 * begin.slope - end.slope) / width,
                            (begin.slope + end.slope - 2.0 * secant) / (width * width)});
  }
  return StrainStressCurve::fromPolynomials(knots, coefficients);
}

MembraneCurves sumOf(const std::vector<Fabric>& layers, Direction direction) {
  const auto sum = [&](Curve curve) {
    return sumOf(layers, [=](const Fabric& layer) -> const StrainStressCurve& {
      return layer.*direction.*curve;
    });
  };
  return {sum(&MembraneCurves::elastic), sum(&MembraneCurves::viscous)};
}

double bendingOf(const std::vector<Fabric>& layers, Direction direction,
                 double BendingRigidity::*own) {
  double rigidity = 0.0, stiffness = 0.0, moment = 0.0, second_moment = 0.0;
  double face = 0.0;  // m, of the layer
  for (const Fabric& layer : layers) {
    const double thickness = layer.compression->thickness;
    const double middle = face + 0.5 * thickness;
    const double slope = (layer.*direction).elastic.evaluate(0.0).slope;
    rigidity += (*layer.bending).*own;
    stiffness += slope;
    moment += slope * middle;
    second_moment += slope * middle * middle;
    face += thickness;
  }
  if (stiffness > 0.0) rigidity += second_moment - moment * moment / stiffness;
  return rigidity;
}

/// At a pressure of at most kMaxFittedPressure, by bisection: pressure rises with strain.
double strainUnder(double pressure, const StrainStressCurve& curve) {
  double low = 0.0, high = 1.0;
  while (true) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) return low;
    (curve.evaluate(middle).stress < pressure ? low : high) = middle;
  }
}

/// Exact under the pressures at which a curve of a layer has a knot.
Compression compressionOf(const std::vector<Fabric>& layers) {
  std::vector<double> pressures{0.0};
  for (const Fabric& layer : layers) {
    for (const double strain : layer.compression->pressure.knots()) {
      const double pressure = layer.compression->pressure.evaluate(strain).stress;
      if (pressure > 0.0 && pressure <= kMaxFittedPressure) pressures.push_back(pressure);
    }
  }
  std::sort(pressures.begin(), pressures.end());
  std::vector<ThicknessPoint> points;
  for (const double pressure : pressures) {
    // Knots of different layers that nearly agree would make an interval of rounding.
    if (!points.empty() && pressure < points.back().pressure * (1.0 + 1e-6)) continue;
    double thickness = 0.0;
    for (const Fabric& layer : layers) {
      const double strain = strainUnder(pressure, layer.compression->pressure);
      thickness += layer.compression->thickness * (1.0 - strain);
    }
    points.push_back({pressure, thickness});
  }
  return compressionFromPoints(points);
}

std::optional<BendingHysteresis> hysteresisOf(const std::vector<Fabric>& layers) {
  BendingHysteresis sum{0.0, 0.0};
  for (const Fabric& layer : layers) {
    if (!layer.bending_hysteresis) return std::nullopt;
    sum.weft += layer.bending_hysteresis->weft;
    sum.warp += layer.bending_hysteresis->warp;
  }
  return sum;
}

void requireSound(const std::vector<Fabric>& layers) {
  if (layers.size() < 2 || layers.size() > kMostLayers) {
    base::refuse("there are ", layers.size(), " layers: allowed are 2 to ", kMostLayers);
  }
  for (const Fabric& layer : layers) {
    const char* missing = !layer.bending ? "bending" : !layer.compression ? "compression" : nullptr;
    if (missing == nullptr) continue;
    base::refuse("layer ", layer.name, " has no ", missing, ", which glued layers need");
  }
}

/// Of what all layers have; measured is nothing of it, as nobody has measured them together.
std::map<std::string, Provenance> provenanceOf(const std::vector<Fabric>& layers) {
  std::string names;
  for (const Fabric& layer : layers) names += (names.empty() ? "" : ", ") + layer.name;
  std::map<std::string, Provenance> provenance;
  for (const auto& of_first : layers.front().provenance) {
    const std::string& key = of_first.first;
    const bool all = std::all_of(layers.begin(), layers.end(), [&](const Fabric& layer) {
      return layer.provenance.count(key) > 0;
    });
    if (!all) continue;
    provenance[key] = {Provenance::Kind::kRepresentative, "Computed for the glued layers " + names};
  }
  return provenance;
}

}  // namespace

Fabric glue(const std::vector<Fabric>& layers, const std::string& name) {
  requireSound(layers);
  Fabric glued;
  glued.name = name;
  glued.provenance = provenanceOf(layers);
  for (const Fabric& layer : layers) glued.areal_density += layer.areal_density;
  glued.weft = sumOf(layers, &Fabric::weft);
  glued.warp = sumOf(layers, &Fabric::warp);
  glued.shear = sumOf(layers, &Fabric::shear);
  glued.bending = BendingRigidity{bendingOf(layers, &Fabric::weft, &BendingRigidity::weft),
                                  bendingOf(layers, &Fabric::warp, &BendingRigidity::warp)};
  glued.bending_hysteresis = hysteresisOf(layers);
  glued.compression = compressionOf(layers);
  glued.friction = layers.front().friction;
  glued.surface = layers.front().surface;
  glued.look = layers.front().look;
  for (const auto& [key, source] : layers.front().provenance) {
    const bool of_face = key == "friction" || key == "look" || key.rfind("surface", 0) == 0;
    if (of_face) glued.provenance[key] = source;
  }
  return glued;
}

}  // namespace haptex::material
