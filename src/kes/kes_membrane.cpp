// KES-FB1: tensile and shear.
#include <cmath>
#include <functional>
#include <stdexcept>

#include "haptex/kes/virtual_kes.h"
#include "haptex/kes/virtual_test.h"
#include "haptex/material/strain_measures.h"

namespace haptex::kes {
namespace {

using Eigen::Vector3d;
using material::Fabric;
using material::MembraneCurves;
using Function = std::function<double(double)>;

constexpr int kTensileSteps = 40;  // even, for Simpson's rule
constexpr double kDegree = M_PI / 180.0;

const MembraneCurves& curvesOf(const Fabric& fabric, Direction direction) {
  return direction == Direction::kWeft ? fabric.weft : fabric.warp;
}

struct Sample {
  double x, value;
};

/// Where a function is zero between two samples on either side: regula falsi with the Illinois
/// weighting, until its value is within the tolerance. The last evaluation is at the root, unless
/// that is the second sample.
double rootOf(const Function& function, Sample first, Sample second, double tolerance) {
  Sample last = second;
  for (int i = 0; i < 100 && std::abs(last.value) > tolerance; ++i) {
    last.x = (first.x * second.value - second.x * first.value) / (second.value - first.value);
    last.value = function(last.x);
    if (last.value * second.value < 0.0) {
      first = second;
    } else {
      first.value *= 0.5;
    }
    second = last;
  }
  return last.x;
}

/// @param count of equally spaced values, odd
double simpson(const std::vector<double>& values, double length) {
  double sum = values.front() + values.back();
  for (std::size_t i = 1; i + 1 < values.size(); ++i) sum += values[i] * (i % 2 == 1 ? 4.0 : 2.0);
  return sum * length / (3.0 * (values.size() - 1));
}

/// Force per width (N/m) of the curves at a rate of engineering strain.
double curveForce(const MembraneCurves& curves, double strain, double rate) {
  const double stretch = 1.0 + strain;
  return stretch * (curves.elastic.evaluate(material::greenStrain(strain)).stress +
                    curves.viscous.evaluate(stretch * rate).stress);
}

/// The strain at the tester's largest load.
double strainAtLoad(const Function& force) {
  const auto lacking = [&](double strain) { return force(strain) - kKesTensileLoad; };
  Sample above{0.01, lacking(0.01)};
  while (above.value < 0.0) {
    above.x *= 2.0;
    if (above.x > 20.0) {
      throw std::runtime_error("the sample does not reach 500 gf/cm at any strain up to 2000 %");
    }
    above.value = lacking(above.x);
  }
  return rootOf(lacking, {0.0, -kKesTensileLoad}, above, 1e-9 * kKesTensileLoad);
}

struct TensileParameters {
  double emt, wt, lt, rt;
};

TensileParameters parametersOf(double emt, double work, double returned) {
  return {100.0 * emt, work / kKesGramPerCentimetre, work / (0.5 * kKesTensileLoad * emt),
          100.0 * returned / work};
}

cloth::ModelledEffects effectsOf(bool hysteresis) {
  cloth::ModelledEffects effects;
  effects.membrane_hysteresis = hysteresis;
  return effects;
}

/// Without the hysteresis of shear, which the test does not meet.
Fabric pulledFabric(Fabric fabric) {
  fabric.shear_hysteresis = {0.0, 0.0};
  return fabric;
}

/// Without that of the threads, which the constant tension hardly moves.
Fabric shearedFabric(Fabric fabric) {
  fabric.resilience = {1.0, 1.0};
  return fabric;
}

void addTensile(const Fabric& fabric, Direction direction, KesResult& result) {
  const MembraneCurves& curves = curvesOf(fabric, direction);
  const bool hysteresis = fabric.resilience.has_value();
  TensileRig rig(pulledFabric(fabric), direction, effectsOf(hysteresis));
  // What the file says of hysteresis is all of it: it is read at rest.
  const double rate = hysteresis ? 0.0 : kKesStrainRate;
  const auto moving = [&](double at_rate) {
    rig.move(at_rate);
    return rig.force() / kSampleWidth;
  };
  const double emt = strainAtLoad([&](double strain) {
    rig.renew();
    rig.pull(strain);
    return moving(rate);
  });
  rig.renew();
  std::vector<double> loading, unloading;
  for (int i = 0; i <= kTensileSteps; ++i) {
    const double strain = emt * i / kTensileSteps;
    rig.pull(strain);
    const double at_rest = rig.force() / kSampleWidth;
    loading.push_back(moving(rate));
    result.points.push_back(
        {"tensile", nameOf(direction), strain, at_rest, curveForce(curves, strain, 0.0)});
  }
  for (int i = kTensileSteps; i >= 0; --i) {
    rig.pull(emt * i / kTensileSteps);
    unloading.push_back(moving(-rate));
  }
  const TensileParameters measured =
      parametersOf(emt, simpson(loading, emt), simpson(unloading, emt));

  const double exact_emt =
      strainAtLoad([&](double strain) { return curveForce(curves, strain, rate); });
  const auto exact_work = [&](double at_rate) {
    constexpr int kParts = 20000;
    std::vector<double> forces;
    for (int i = 0; i <= kParts; ++i) {
      forces.push_back(curveForce(curves, exact_emt * i / kParts, at_rate));
    }
    return simpson(forces, exact_emt);
  };
  double resilience = 1.0;
  if (hysteresis) {
    const auto& [weft, warp] = *fabric.resilience;
    resilience = direction == Direction::kWeft ? weft : warp;
  }
  const TensileParameters exact =
      parametersOf(exact_emt, exact_work(rate), resilience * exact_work(-rate));
  const std::string of = std::string("/") + nameOf(direction);
  result.parameters.push_back({"LT" + of, "-", exact.lt, measured.lt});
  result.parameters.push_back({"WT" + of, "gf.cm/cm2", exact.wt, measured.wt});
  result.parameters.push_back({"RT" + of, "%", exact.rt, measured.rt});
  result.parameters.push_back({"EMT" + of, "%", exact.emt, measured.emt});
}

/// The next elongation to try of threads that give way to the tension of the shear test.
double longerThan(double elongation) {
  if (elongation > 20.0) {
    throw std::runtime_error("the threads do not bear 10 gf/cm at any strain up to 2000 %");
  }
  return 2.0 * elongation;
}

/// The sample under shear, its jaws pulled apart by the tester's tension.
class TensionedShear {
 public:
  TensionedShear(const Fabric& fabric, Direction direction)
      : rig_(shearedFabric(fabric), direction, effectsOf(fabric.shear_hysteresis.has_value())) {}

  /// Shears by an angle (degrees) and lets the jaw find its height.
  void shear(double angle) {
    tangent_ = std::tan(angle * kDegree);
    const auto settle = [&](double elongation, const Vector3d& disturbance) {
      height_ = std::cos(angle * kDegree) * (1.0 + elongation);
      rig_.shear(height_ * tangent_, height_, disturbance);
    };
    const auto lacking = [&](double elongation) {  // of the pulled threads
      settle(elongation, Vector3d::Zero());
      return rig_.force().across / kSampleWidth - kKesShearTension;
    };
    // At rest they do not pull. From one angle to the next the elongation hardly changes.
    Sample above{elongation_ > 0.0 ? 1.01 * elongation_ : 1e-3, 0.0};
    while ((above.value = lacking(above.x)) < 0.0) above.x = longerThan(above.x);
    elongation_ = rootOf(lacking, {0.0, -kKesShearTension}, above, 1e-8 * kKesShearTension);
    settle(elongation_, StaticSample::kDisturbance);  // only what is read has to find its way back
  }

  /// Force per width (N/m) along the shear at a rate of shear, without the tension's part along it.
  double force(double rate) {
    rig_.move(rate, -tangent_ * rate);  // the pulled threads keep their length
    const ShearRig::Force force = rig_.force();
    return (force.along - tangent_ * force.across) / kSampleWidth;
  }
  double shearStrain() const { return height_ * tangent_; }  ///< U.V

 private:
  ShearRig rig_;
  double tangent_ = 0.0, height_ = 1.0, elongation_ = 0.0;
};

struct ShearParameters {
  double g, hg, hg5;
};
const std::vector<double> kAngles = {-8.0, -7.0, -6.0, -5.0, -4.0, -3.0, -2.5,
                                     -2.0, -1.0, -0.5, 0.0,  0.5,  1.0,  2.0,
                                     2.5,  3.0,  4.0,  5.0,  6.0,  7.0,  8.0};
constexpr int kNoAngle = 10;

/// Forces (N/m) by kAngles.
struct ShearCycle {
  std::vector<double> loading, unloading;
  std::vector<double> at_rest;  // the mean of both ways, where they are not the same
};

/// At rest, from no angle to the largest on one side, to that on the other, and back.
ShearCycle readHysteresis(TensionedShear& sample) {
  const int last = static_cast<int>(kAngles.size()) - 1;
  ShearCycle cycle;
  cycle.loading.resize(kAngles.size());
  cycle.unloading.resize(kAngles.size());
  const auto read = [&](int i) {
    sample.shear(kAngles[i]);
    return sample.force(0.0);
  };
  for (int i = kNoAngle; i <= last; ++i) cycle.loading[i] = read(i);
  cycle.unloading[last] = cycle.loading[last];
  for (int i = last - 1; i >= 0; --i) cycle.unloading[i] = read(i);
  cycle.loading[0] = cycle.unloading[0];
  for (int i = 1; i <= kNoAngle; ++i) cycle.loading[i] = read(i);
  for (int i = 0; i <= last; ++i) {
    cycle.at_rest.push_back(0.5 * (cycle.loading[i] + cycle.unloading[i]));
  }
  return cycle;
}

/// Without a hysteresis that remembers: passed through both ways at every angle.
ShearCycle readViscosity(TensionedShear& sample) {
  ShearCycle cycle;
  for (double angle : kAngles) {
    sample.shear(angle);
    cycle.at_rest.push_back(sample.force(0.0));
    cycle.loading.push_back(sample.force(kKesShearRate));
    cycle.unloading.push_back(sample.force(-kKesShearRate));
  }
  return cycle;
}

/// G is the mean slope from 0.5 to 2.5 degrees of both branches on both sides.
ShearParameters parametersOf(const ShearCycle& cycle) {
  const auto at = [&](double angle) {
    std::size_t i = 0;
    while (kAngles[i] != angle) ++i;
    return i;
  };
  const auto mean = [&](double angle) {
    return 0.5 * (cycle.loading[at(angle)] + cycle.unloading[at(angle)]);
  };
  const auto width = [&](double angle) {
    return 0.5 * (cycle.loading[at(angle)] - cycle.unloading[at(angle)] +
                  cycle.loading[at(-angle)] - cycle.unloading[at(-angle)]);
  };
  const double slope = 0.25 * (mean(2.5) - mean(0.5) + mean(-0.5) - mean(-2.5));
  return {slope / kKesGramPerCentimetre, width(0.5) / kKesGramPerCentimetre,
          width(5.0) / kKesGramPerCentimetre};
}

/// What the file says: the elastic curve at rest, and on both ways viscosity or hysteresis.
ShearCycle exactCycle(const Fabric& fabric, Direction pulled) {
  ShearCycle exact;
  for (double angle : kAngles) {
    // The rate of U.V is that of the jaw: U stays.
    const double strain = exactShearStrain(curvesOf(fabric, pulled), angle);
    const double elastic = fabric.shear.elastic.evaluate(strain).stress;
    double more = fabric.shear.viscous.evaluate(kKesShearRate).stress;
    double less = fabric.shear.viscous.evaluate(-kKesShearRate).stress;
    double turn = 0.0;
    if (const auto& hysteresis = fabric.shear_hysteresis) {
      more =
          0.5 * (std::abs(angle) < 5.0 ? hysteresis->at_half_degree : hysteresis->at_five_degrees);
      less = -more;
      // The cycle turns at its ends, where friction resists on both ways in the same direction.
      if (std::abs(angle) == kKesLargestShear) turn = std::copysign(more, angle);
    }
    exact.at_rest.push_back(elastic + turn);
    exact.loading.push_back(elastic + more);
    exact.unloading.push_back(elastic + less);
  }
  return exact;
}

void addShear(const Fabric& fabric, Direction direction, KesResult& result) {
  const Direction pulled = direction == Direction::kWeft ? Direction::kWarp : Direction::kWeft;
  TensionedShear sample(fabric, direction);
  const ShearCycle measured =
      fabric.shear_hysteresis ? readHysteresis(sample) : readViscosity(sample);
  const ShearCycle exact = exactCycle(fabric, pulled);
  for (std::size_t i = 0; i < kAngles.size(); ++i) {
    result.points.push_back(
        {"shear", nameOf(direction), kAngles[i], measured.at_rest[i], exact.at_rest[i]});
  }
  const ShearParameters found = parametersOf(measured), in = parametersOf(exact);
  const std::string of = std::string("/") + nameOf(direction);
  result.parameters.push_back({"G" + of, "gf/(cm.deg)", in.g, found.g});
  result.parameters.push_back({"2HG" + of, "gf/cm", in.hg, found.hg});
  result.parameters.push_back({"2HG5" + of, "gf/cm", in.hg5, found.hg5});
}

}  // namespace

KesResult kesTensile(const Fabric& fabric) {
  KesResult result;
  addTensile(fabric, Direction::kWeft, result);
  addTensile(fabric, Direction::kWarp, result);
  return result;
}

KesResult kesShear(const Fabric& fabric) {
  KesResult result;
  addShear(fabric, Direction::kWeft, result);
  addShear(fabric, Direction::kWarp, result);
  return result;
}

}  // namespace haptex::kes
