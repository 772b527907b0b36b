// What testers would read of a fabric, by its own curves and laws of friction (docs/mechanics.md).
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>
#include <string>

#include "haptex/base/repeatable_random.h"
#include "haptex/material/fabric.h"
#include "haptex/material/kes_conditions.h"
#include "haptex/material/strain_measures.h"

namespace haptex::material {

/// Readings of a KES tester in its own units, both branches, as a file of readings. Compression
/// gives back the share sqrt(p / p_m) of the pressure.
class VirtualReadings {
 public:
  /// @param noise of every y, uniform within this share of the largest
  explicit VirtualReadings(const Fabric& fabric, double noise = 0.0)
      : fabric_(fabric), noise_(noise) {
    text_.precision(6);
    text_ << "# units: tensile % gf/cm\n# units: shear deg gf/cm\n# units: bending 1/cm gf.cm/cm\n"
             "# units: compression mm gf/cm2\ntest,direction,branch,x,y\n"
          << "value,,W," << 100.0 * fabric.areal_density << ",mg/cm2\n";
    if (fabric.friction) text_ << "value,,MIU," << *fabric.friction << ",1\n";
    tensile("weft", fabric.weft, fabric.resilience->weft);
    tensile("warp", fabric.warp, fabric.resilience->warp);
    shear("weft", fabric.warp);
    shear("warp", fabric.weft);
    bending("weft", fabric.bending->weft, fabric.bending_hysteresis->weft);
    bending("warp", fabric.bending->warp, fabric.bending_hysteresis->warp);
    compression();
  }
  std::string text() const { return text_.str(); }

 private:
  void row(const std::string& what, bool loading, double x, double y, double scale) {
    text_ << what << (loading ? ",loading," : ",unloading,") << x << ','
          << y + scale * noise_ * random_.uniform(-1.0, 1.0) << '\n';
  }

  /// The work falls to P = Qm/(1 + k) times 1 - k before all friction has turned round.
  void tensile(const std::string& direction, const MembraneCurves& curves, double resilience) {
    const double k = 0.1, r = (1.0 + k) * (1.0 - resilience) / 2.0;
    const auto force = [&](double strain) {
      return (1.0 + strain) * curves.elastic.evaluate(greenStrain(strain)).stress;
    };
    double most = 1e-4;
    while (force(most) < kKesTensileLoad) most += 1e-4;
    const double p = curves.elastic.energy(greenStrain(most)) / (1.0 + k);
    constexpr int kReadings = 80;
    for (int i = 0; i <= 2 * kReadings; ++i) {
      const bool loading = i <= kReadings;
      const double strain = most * (loading ? i : 2 * kReadings - i) / kReadings;
      const double q = curves.elastic.energy(greenStrain(strain));
      const double t = loading ? 1.0 : std::clamp((q - p) / (k * p), -1.0, 1.0);
      row("tensile," + direction, loading, 100.0 * strain,
          force(strain) * (1.0 - r + r * t) / kKesGramPerCentimetre,
          kKesTensileLoad / kKesGramPerCentimetre);
    }
  }

  /// From no x to the largest, to that on the other side, and back: a spring of length `yield` in
  /// series with a sliding block. @param line writes a reading of x and t, -1 to 1
  static void cycle(double most, double yield,
                    const std::function<void(bool, double, double)>& line) {
    constexpr int kReadings = 64;
    double slipped = 0.0;
    for (int i = 0; i <= 4 * kReadings; ++i) {
      const int from_side = std::abs(i - 3 * kReadings);
      const double part = i <= kReadings ? i : from_side - kReadings;
      const double x = most * part / kReadings;
      slipped = std::clamp(slipped, x - yield, x + yield);
      const bool loading = i <= kReadings || (i > 2 * kReadings && i <= 3 * kReadings);
      line(loading, x, (x - slipped) / yield);
    }
  }

  void shear(const std::string& direction, const MembraneCurves& pulled) {
    const double most = fabric_.shear.elastic.evaluate(exactShearStrain(pulled, 8.0)).stress;
    cycle(8.0, 0.005 * 180.0 / M_PI, [&](bool loading, double angle, double t) {
      const double part = std::clamp((std::abs(angle) - 0.5) / 4.5, 0.0, 1.0);
      const double width = (1.0 - part) * fabric_.shear_hysteresis->at_half_degree +
                           part * fabric_.shear_hysteresis->at_five_degrees;
      const double elastic = fabric_.shear.elastic.evaluate(exactShearStrain(pulled, angle)).stress;
      row("shear," + direction, loading, angle, (elastic + 0.5 * width * t) / kKesGramPerCentimetre,
          most / kKesGramPerCentimetre);
    });
  }

  void bending(const std::string& direction, double rigidity, double width) {
    cycle(250.0, 20.0, [&](bool loading, double curvature, double t) {
      row("bending," + direction, loading, 0.01 * curvature,
          (rigidity * curvature + 0.5 * width * t) / 9.80665e-3, rigidity * 250.0 / 9.80665e-3);
    });
  }

  void compression() {
    const Compression& compression = *fabric_.compression;
    double thin = compression.thickness;
    const auto pressure = [&](double thickness) {
      return compression.pressure.evaluate(1.0 - thickness / compression.thickness).stress;
    };
    while (pressure(thin) < 4903.325) thin -= 1e-8;
    constexpr int kReadings = 120;
    for (int i = 0; i <= 2 * kReadings; ++i) {
      const bool loading = i <= kReadings;
      const double part = static_cast<double>(loading ? i : 2 * kReadings - i) / kReadings;
      const double thickness = compression.thickness + part * (thin - compression.thickness);
      const double p = pressure(thickness);
      text_ << "compression,," << (loading ? "loading," : "unloading,")
            << 1e3 * thickness * (1.0 + noise_ * 0.2 * random_.uniform(-1.0, 1.0)) << ','
            << (loading ? p : p * std::sqrt(p / 4903.325)) / 98.0665 << '\n';
    }
  }

  const Fabric& fabric_;
  double noise_;
  base::RepeatableRandom random_{7};
  std::ostringstream text_;
};

}  // namespace haptex::material
