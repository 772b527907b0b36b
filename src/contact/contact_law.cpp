#include "haptex/contact/contact_law.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "haptex/base/quoted.h"

namespace haptex::contact {
namespace {

using material::CurveValue;
using material::StrainStressCurve;

constexpr double kDeepest = 5e-3;        // m: tabulated at least to here
constexpr double kMaxPressure = 2e6;     // Pa: or to here
constexpr double kRelativeError = 1e-5;  // of the pressure in the middle of an interval
constexpr double kNarrowest = 1e-6;      // of the range of strain: no finer intervals

// Mindlin 1949 (J. Appl. Mech. 16:259): where two elastic bodies stick over their area of contact,
// the ratio of the tangential stiffness to the normal one is 2 (1 - nu) / (2 - nu); 2/3 for a pulp
// that keeps its volume (nu = 0.5). The fabric adds no yield of its own: KES does not measure shear
// through the thickness.
constexpr double kTangentialByNormal = 2.0 / 3.0;

void requireContactProperties(const material::Fabric& fabric) {
  const auto require_property = [&](bool present, const std::string& property) {
    if (!present) {
      throw std::invalid_argument("fabric " + base::shortened(fabric.name) +
                                  ": contact needs the property '" + property + "'");
    }
  };
  require_property(fabric.compression.has_value(), "compression");
  require_property(fabric.friction.has_value(), "friction");
}

void requirePositive(const std::string& name, double value) {
  if (!std::isfinite(value) || value <= 0.0) {
    std::ostringstream message;
    message << "pulp: " << name << ' ' << value << " must be finite and > 0";
    throw std::invalid_argument(message.str());
  }
}

// A point of the law: both springs carry the same pressure.
struct Sample {
  double strain;        // of the fabric
  double depth;         // m
  CurveValue pressure;  // Pa, Pa/m
};

// The law by the fabric's strain, which gives pressure and depth without solving for anything.
class SeriesLaw {
 public:
  SeriesLaw(const material::Compression& fabric, double pulp_stiffness)
      : fabric_(fabric), pulp_stiffness_(pulp_stiffness) {}

  Sample at(double strain) const {
    const CurveValue value = fabric_.pressure.evaluate(strain);
    const double half = 0.5 * fabric_.thickness;
    const double depth = value.stress / pulp_stiffness_ + half * strain;
    const double depth_by_strain = value.slope / pulp_stiffness_ + half;
    return {strain, depth, {value.stress, value.slope / depth_by_strain}};
  }

 private:
  const material::Compression& fabric_;
  double pulp_stiffness_;
};

using Cubic = std::array<double, 4>;

Cubic hermite(const Sample& begin, const Sample& end) {
  const double width = end.depth - begin.depth;
  const double secant = (end.pressure.stress - begin.pressure.stress) / width;
  const double b = begin.pressure.slope, e = end.pressure.slope;
  return {begin.pressure.stress, b, (3.0 * secant - 2.0 * b - e) / width,
          (b + e - 2.0 * secant) / (width * width)};
}

// Close enough to the law, and monotone: slopes of at most three times the secant are sufficient
// (Fritsch and Carlson 1980).
bool isGood(const SeriesLaw& law, const Sample& begin, const Sample& end) {
  const double secant = (end.pressure.stress - begin.pressure.stress) / (end.depth - begin.depth);
  if (begin.pressure.slope > 3.0 * secant || end.pressure.slope > 3.0 * secant) return false;
  const Cubic c = hermite(begin, end);
  for (const double part : {0.25, 0.5, 0.75}) {
    const Sample inside = law.at(begin.strain + part * (end.strain - begin.strain));
    const double x = inside.depth - begin.depth;
    const double pressure = c[0] + x * (c[1] + x * (c[2] + x * c[3]));
    if (std::abs(pressure - inside.pressure.stress) > kRelativeError * inside.pressure.stress) {
      return false;
    }
  }
  return true;
}

// Halves intervals until they are good enough; appends their ends in order.
void refine(const SeriesLaw& law, const Sample& begin, const Sample& end, double narrowest,
            std::vector<Sample>& samples) {
  if (end.strain - begin.strain <= narrowest || isGood(law, begin, end)) {
    samples.push_back(end);
    return;
  }
  const Sample middle = law.at(0.5 * (begin.strain + end.strain));
  refine(law, begin, middle, narrowest, samples);
  refine(law, middle, end, narrowest, samples);
}

// Where the depth or the pressure is reached up to which the law is tabulated.
double lastStrain(const SeriesLaw& law) {
  const auto reached = [&](double strain) {
    const Sample sample = law.at(strain);
    return sample.depth >= kDeepest || sample.pressure.stress >= kMaxPressure;
  };
  double below = 0.0, strain = 1.0;
  while (!reached(strain)) strain *= 2.0;
  while (strain - below > 1e-9 * strain) {
    const double middle = 0.5 * (below + strain);
    (reached(middle) ? strain : below) = middle;
  }
  return strain;
}

StrainStressCurve tabulate(const material::Compression& fabric, double pulp_stiffness) {
  const SeriesLaw law(fabric, pulp_stiffness);
  std::vector<Sample> samples = {law.at(0.0)};
  const double last = lastStrain(law);
  refine(law, samples.front(), law.at(last), kNarrowest * last, samples);
  std::vector<double> knots;
  std::vector<Cubic> coefficients;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    knots.push_back(samples[i].depth);
    if (i > 0) coefficients.push_back(hermite(samples[i - 1], samples[i]));
  }
  return StrainStressCurve::fromPolynomials(knots, coefficients);
}

}  // namespace

ContactLaw::ContactLaw(const material::Fabric& fabric, const PulpSettings& pulp, int most_layers) {
  requireContactProperties(fabric);
  requirePositive("stiffness", pulp.stiffness);
  requirePositive("damping", pulp.damping);
  // Layers in series are compressed by the same strain: a fabric as thick as all of them, of which
  // the half on the fingertip's side is what lies between it and the middle surface.
  for (int layers = 0; layers < most_layers; ++layers) {
    const material::Compression& one = *fabric.compression;
    pressures_.push_back(
        tabulate({(2.0 * layers + 1.0) * one.thickness, one.pressure}, pulp.stiffness));
  }
  half_thickness_ = 0.5 * fabric.compression->thickness;
  friction_ = *fabric.friction;
  damping_ = pulp.damping;
  tangential_stiffness_ = kTangentialByNormal * pulp.stiffness;
}

material::CurveValue ContactLaw::pressure(double depth) const {
  if (depth <= 0.0) return {0.0, 0.0};
  return pressures_.front().evaluate(depth);
}

material::CurveValue ContactLaw::pressureThrough(double layers_before, double distance) const {
  const int last = static_cast<int>(pressures_.size()) - 1;
  const int below = std::clamp(static_cast<int>(layers_before), 0, last);
  CurveValue sum{0.0, 0.0};
  for (int layers = below; layers <= std::min(below + 1, last); ++layers) {
    const double share = std::max(0.0, 1.0 - std::abs(layers_before - layers));
    const double depth = reachThrough(layers) - distance;
    if (depth <= 0.0 || share == 0.0) continue;
    const CurveValue value = pressures_[layers].evaluate(depth);
    sum.stress += share * value.stress;
    sum.slope += share * value.slope;
  }
  return sum;
}

}  // namespace haptex::contact
