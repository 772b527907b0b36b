// The oracles of the material room.
#include <algorithm>
#include <cmath>
#include <limits>

#include "haptex/material/fabric_file.h"
#include "haptex/material/strain_measures.h"
#include "haptex/oracles/checks/validation.h"

namespace haptex::oracles {
namespace {

using material::CurvePoint;
using material::Fabric;
using material::StrainStressCurve;

void validateConversions(const Sink& sink) {
  double back_and_forth = 0.0;
  for (int percent = -90; percent < 200; ++percent) {
    const double strain = 0.01 * percent;
    const double green = material::greenStrain(strain);
    back_and_forth =
        base::largerOrNaN(back_and_forth, std::abs(material::engineeringStrain(green) - strain));
    const double force = 100.0;
    const double stress = material::secondPiolaStress(force, strain);
    back_and_forth = base::largerOrNaN(
        back_and_forth, std::abs(material::forcePerWidth(stress, green) / force - 1.0));
  }
  sink({"material/conversion/back_and_forth", 0.0, back_and_forth, back_and_forth, kRounding});
  // Stretch 1.25: strain (1.25^2 - 1)/2 and stress 490/1.25, both exact in binary.
  sink(base::relativeTo(1.0, "material/conversion/green_strain_at_0.25", 0.28125,
                        material::greenStrain(0.25), kRounding));
  sink(base::relativeTo(392.0, "material/conversion/second_piola_of_490_at_0.25", 392.0,
                        material::secondPiolaStress(490.0, 0.25), kRounding));
}

/// The sample that the fitted curve misses by most, relative to the largest stress.
void validateSamples(const std::string& fabric, const std::string& name,
                     const StrainStressCurve& curve, const std::vector<CurvePoint>& samples,
                     const Sink& sink) {
  double peak = 0.0;
  for (const CurvePoint& sample : samples) peak = std::max(peak, std::abs(sample.stress));
  base::Quantity worst{"", 0.0, 0.0, -1.0, 0.0};
  for (const CurvePoint& sample : samples) {
    base::keepWorse(worst,
                    base::relativeTo(peak, "material/samples/" + fabric + "/" + name, sample.stress,
                                     curve.evaluate(sample.strain).stress, kRounding));
  }
  sink(worst);
}

/// Energy at the last knot against Simpson's rule, exact for cubics, on every interval.
void validateEnergy(const std::string& fabric, const std::string& name,
                    const StrainStressCurve& curve, const std::vector<CurvePoint>& samples,
                    const Sink& sink) {
  double integral = 0.0;
  double before = 0.0;
  for (const CurvePoint& sample : samples) {
    if (sample.strain <= 0.0) continue;
    const double middle = 0.5 * (before + sample.strain);
    integral += (sample.strain - before) / 6.0 *
                (curve.evaluate(before).stress + 4.0 * curve.evaluate(middle).stress +
                 curve.evaluate(sample.strain).stress);
    before = sample.strain;
  }
  sink(base::relativeTo(integral, "material/energy/" + fabric + "/" + name, integral,
                        curve.energy(before), kRounding));
}

}  // namespace

void validateMaterial(const std::string& config_directory, const Sink& sink) {
  validateConversions(sink);
  for (const std::string name : {"wool", "acrylic_knit", "cotton_knit"}) {
    const std::string path = config_directory + "/fabrics/" + name + ".yaml";
    const Fabric fabric = material::loadFabric(path);
    const auto check = [&](const std::string& key, const StrainStressCurve& curve) {
      const std::vector<CurvePoint> samples = fabricSamples(path, key);
      validateSamples(name, key, curve, samples, sink);
      validateEnergy(name, key, curve, samples, sink);
    };
    check("weft.elastic", fabric.weft.elastic);
    check("warp.elastic", fabric.warp.elastic);
    if (name == "wool") check("shear.elastic", fabric.shear.elastic);
  }
}

}  // namespace haptex::oracles
