#include "haptex/material/tester_fabric.h"

#include <cmath>
#include <filesystem>
#include <sstream>

#include "haptex/base/constants.h"
#include "haptex/base/require.h"
#include "haptex/material/kes_conditions.h"
#include "haptex/material/strain_measures.h"
#include "haptex/material/tester_fits.h"

namespace haptex::material {
namespace {

// Loads of FAST, which it states in gf.
constexpr double kFastLoads[] = {5 * kKesGramPerCentimetre, 20 * kKesGramPerCentimetre,
                                 100 * kKesGramPerCentimetre};             // N/m
constexpr double kFastLowPressure = 196.133, kFastHighPressure = 9806.65;  // Pa, 2 and 100 gf/cm2
constexpr double kFastBiasModulus = 1.23;  // N/m, over the extension on the bias as a ratio
constexpr int kKesCurvePoints = 40;

/// The exponential that bends as LT says: with x = e / EMT and g = LT/2 the work,
///   1/a - 1/(exp(a) - 1) = g,
/// which falls with a from 1 to 0; a = 0 is the straight line.
double exponentOf(double linearity) {
  const auto work = [](double a) {
    return std::abs(a) < 1e-4 ? 0.5 - a / 12.0 : 1.0 / a - 1.0 / std::expm1(a);
  };
  double low = -20.0, high = 20.0;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (work(middle) > 0.5 * linearity ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

std::string percentOf(const Residuals& residuals, double value) {
  std::ostringstream text;
  text.precision(2);
  text << 100.0 * value / residuals.scale << " %";
  return text.str();
}

class Fitter {
 public:
  Fitter(const TesterFile& file, const std::string& name, int pieces)
      : file_(file), pieces_(pieces) {
    fabric().name = name;
    fabric().measured = file.measured;
    const std::string csv = std::filesystem::path(file.path).filename().string();
    source_ = (file.source.empty() ? "" : file.source + "; ") + csv;
  }

  TesterFit fit() {
    const std::optional<double> weight = file_.value("W");
    if (!weight) refuse("areal density", "is missing: give the value W");
    fabric().areal_density = {*weight, from("value W")};
    fabric().weft = tensile("weft");
    fabric().warp = tensile("warp");
    addResilience();
    addShear();
    addBending();
    addCompression();
    addSurface();
    return std::move(result_);
  }

 private:
  TesterFabric& fabric() { return result_.fabric; }

  [[noreturn]] void refuse(const std::string& property, const std::string& what) const {
    base::refuse(file_.path, ": ", property, " ", what);
  }
  /// Runs `make` and gives what it refuses the file and the property.
  template <typename Make>
  auto naming(const std::string& property, Make make) const {
    try {
      return make();
    } catch (const std::exception& error) {
      refuse(property, error.what());
    }
  }

  std::string from(const std::string& what) const { return source_ + ": " + what; }
  std::string fromFit(const std::string& what, std::size_t readings,
                      const Residuals& residuals) const {
    return from(std::to_string(readings) + " readings of " + what + ", fitted by " +
                std::to_string(pieces_) + " rising cubics; residuals " +
                percentOf(residuals, residuals.rms) + " RMS, " +
                percentOf(residuals, residuals.largest) + " at most, of the largest");
  }

  void report(const std::string& name, std::size_t readings, int pieces, const Residuals& residuals,
              const std::string& unit) {
    result_.report.curves.push_back({name, readings, pieces, residuals, unit});
  }
  /// @param value in SI, as what the file may state
  void parameter(const std::string& name, const std::string& direction, const std::string& unit,
                 double factor, double value) {
    std::optional<double> stated = file_.value(name, direction);
    if (stated) *stated /= factor;
    result_.report.parameters.push_back(
        {name + (direction.empty() ? "" : "/" + direction), unit, value / factor, stated});
  }

  Sourced<StatedCurve> tensile(const std::string& direction) {
    const std::string property = "tensile " + direction;
    const ReadingLoop& loop = file_.loop(TesterTest::kTensile, direction);
    if (!loop.loading.empty() || !loop.unloading.empty()) {
      const ElasticFit fit = naming(property, [&] { return fitTensile(loop, pieces_); });
      report("tensile/" + direction, fit.readings, pieces_, fit.residuals, "N/m");
      return {fit.curve, fromFit("the first pull", fit.readings, fit.residuals)};
    }
    if (const auto extension = file_.value("EMT", direction))
      return kesTensile(direction, *extension);
    std::vector<CurvePoint> points = {{0.0, 0.0}};
    const char* const names[] = {"E5", "E20", "E100"};
    for (int i = 0; i < 3; ++i) {
      const auto extension = file_.value(names[i], direction);
      if (!extension) {
        refuse(property,
               "is missing: give readings of tensile, the KES values EMT and LT or WT, or "
               "the FAST values E5, E20 and E100");
      }
      if (*extension <= points.back().strain) {
        refuse(property, std::string(names[i]) + " must be greater than the extension before");
      }
      points.push_back({*extension, kFastLoads[i]});
    }
    return {points, from("FAST values E5, E20, E100, at 4.9, 19.6 and 98.1 N/m")};
  }

  Sourced<StatedCurve> kesTensile(const std::string& direction, double extension) const {
    std::optional<double> linearity = file_.value("LT", direction);
    if (const auto work = file_.value("WT", direction); work && !linearity) {
      linearity = *work / (0.5 * kKesTensileLoad * extension);
      if (*linearity < 0.3 || *linearity > 1.5) {
        refuse("tensile " + direction, "has the linearity LT " + base::shortNumber(*linearity) +
                                           " by WT and EMT; it must be from 0.3 to 1.5");
      }
    }
    if (!linearity) refuse("tensile " + direction, "has EMT without LT or WT: give one of them");
    const double exponent = exponentOf(*linearity);
    std::vector<CurvePoint> points;
    for (int i = 0; i <= kKesCurvePoints; ++i) {
      const double x = static_cast<double>(i) / kKesCurvePoints;
      const double share =
          std::abs(exponent) < 1e-6 ? x : std::expm1(exponent * x) / std::expm1(exponent);
      points.push_back({extension * x, kKesTensileLoad * share});
    }
    return {points, from("KES values EMT and LT (or WT); an exponential to 500 gf/cm with these")};
  }

  StrainStressCurve curveOf(const StatedCurve& stated) const {
    if (const auto* cubic = std::get_if<PiecewiseCubic>(&stated)) {
      return StrainStressCurve::fromPolynomials(cubic->knots, cubic->coefficients);
    }
    return StrainStressCurve::fit(curvePointsFromTester(std::get<std::vector<CurvePoint>>(stated)),
                                  NegativeBranch::kLinear);
  }

  void addResilience() {
    std::optional<double> found[2];
    const char* const directions[] = {"weft", "warp"};
    bool read = false;
    for (int i = 0; i < 2; ++i) {
      const std::string direction = directions[i], property = "tensile " + direction;
      found[i] = naming(
          property, [&] { return tensileResilience(file_.loop(TesterTest::kTensile, direction)); });
      if (found[i]) {
        read = true;
        parameter("RT", direction, "%", 0.01, *found[i]);
        if (*found[i] < TensileResilience::kLeast || *found[i] > 1.0) {
          refuse(property, "returns " + base::shortNumber(100.0 * *found[i]) +
                               " % of the work (RT); it must be from 10 to 100 %");
        }
      } else if ((found[i] = file_.value("RT", direction))) {
        parameter("RT", direction, "%", 0.01, *found[i]);
      }
    }
    if (found[0].has_value() != found[1].has_value()) {
      refuse("resilience",
             "is there of one direction only: give unloading readings of tensile or RT "
             "of both, or of none");
    }
    if (!found[0]) return;
    fabric().resilience = {{*found[0], *found[1]},
                           from(read ? "work of both branches of tensile (RT)" : "value RT")};
  }

  std::optional<ShearHysteresis> statedShearHysteresis() const {
    const auto low = file_.value("2HG"), high = file_.value("2HG5");
    if (low.has_value() != high.has_value()) {
      refuse("shear", "has one of 2HG and 2HG5 only: give both or none");
    }
    if (!low) return std::nullopt;
    return ShearHysteresis{*low, *high};
  }

  void addShear() {
    const std::optional<ShearHysteresis> stated = statedShearHysteresis();
    std::vector<ShearedSample> samples;
    for (const std::string direction : {"weft", "warp"}) {
      const ReadingLoop& loop = file_.loop(TesterTest::kShear, direction);
      if (loop.loading.empty() && loop.unloading.empty()) continue;
      // The tension pulls the threads across the jaws.
      const StatedCurve& pulled = direction == "weft" ? fabric().warp.value : fabric().weft.value;
      samples.push_back({loop, {curveOf(pulled), {}}});
    }
    if (samples.empty()) {
      addShearModulus();
      if (stated) fabric().shear_hysteresis = {*stated, from("values 2HG and 2HG5")};
    } else {
      const ShearFit fit = naming("shear", [&] { return fitShear(samples, stated, pieces_); });
      const auto& [curve, readings, residuals] = fit.elastic;
      report("shear", readings, pieces_, residuals, "N/m");
      fabric().shear = {withMirrorImage(curve),
                        fromFit("shear, to the middle of the loop", readings, residuals)};
      const double first = std::tan(0.5 * M_PI / 180.0), last = std::tan(2.5 * M_PI / 180.0);
      parameter("G", "", "gf/(cm.deg)", kKesGramPerCentimetre * 180.0 / M_PI,
                (curve.evaluate(last) - curve.evaluate(first)) / (last - first));
      const bool loops = !samples.front().loop.unloading.empty();
      if (fit.hysteresis) {
        fabric().shear_hysteresis = {
            *fit.hysteresis, from(loops ? "loops of shear (2HG, 2HG5)" : "values 2HG and 2HG5")};
      }
    }
    if (const auto& hysteresis = fabric().shear_hysteresis) {
      parameter("2HG", "", "gf/cm", kKesGramPerCentimetre, hysteresis->value.at_half_degree);
      parameter("2HG5", "", "gf/cm", kKesGramPerCentimetre, hysteresis->value.at_five_degrees);
    }
  }

  void addShearModulus() {
    if (const auto modulus = file_.value("G")) {
      fabric().shear = {*modulus, from("value G")};
    } else if (const auto extension = file_.value("EB5")) {
      fabric().shear = {kFastBiasModulus / *extension, from("FAST value EB5, G = 123 / EB5")};
    } else {
      refuse("shear", "is missing: give readings of shear, the value G, or the FAST value EB5");
    }
  }

  void addBending() {
    std::optional<double> rigidity[2], width[2];
    const char* const directions[] = {"weft", "warp"};
    std::string rigidity_source = "value B", width_source = "value 2HB";
    for (int i = 0; i < 2; ++i) {
      const std::string direction = directions[i];
      const ReadingLoop& loop = file_.loop(TesterTest::kBending, direction);
      rigidity[i] = file_.value("B", direction);
      width[i] = file_.value("2HB", direction);
      if (!loop.loading.empty() || !loop.unloading.empty()) {
        const BendingFit fit = naming("bending " + direction, [&] { return fitBending(loop); });
        report("bending/" + direction, fit.readings, 1, fit.residuals, "N");
        rigidity[i] = fit.rigidity;
        rigidity_source = "slopes of bending from 0.5 to 1.5 1/cm (B)";
        if (fit.hysteresis) {
          width[i] = fit.hysteresis;
          width_source = "loops of bending at 1 1/cm (2HB)";
        }
      } else if (const auto length = file_.value("C", direction); length && !rigidity[i]) {
        rigidity[i] = fabric().areal_density.value * base::kStandardGravity * std::pow(*length, 3);
        rigidity_source = "FAST bending length C, B = W g C^3";
      }
      if (rigidity[i]) parameter("B", direction, "gf.cm2/cm", 9.80665e-5, *rigidity[i]);
      if (width[i]) parameter("2HB", direction, "gf.cm/cm", 9.80665e-3, *width[i]);
    }
    const auto both = [&](const std::optional<double>(&of)[2], const std::string& what) {
      if (of[0].has_value() != of[1].has_value()) {
        refuse("bending", "has " + what + " of one direction only: give both or none");
      }
      return of[0].has_value();
    };
    const bool has_rigidity = both(rigidity, "the rigidity"), has_width = both(width, "2HB");
    if (has_width && !has_rigidity) refuse("bending", "has 2HB without a rigidity: give B");
    if (has_rigidity) fabric().bending = {{*rigidity[0], *rigidity[1]}, from(rigidity_source)};
    if (has_width) fabric().bending_hysteresis = {{*width[0], *width[1]}, from(width_source)};
  }

  void addCompression() {
    const ReadingLoop& loop = file_.loop(TesterTest::kCompression);
    std::optional<double> resilience = file_.value("RC");
    if (!loop.loading.empty() || !loop.unloading.empty()) {
      const CompressionFit fit =
          naming("compression", [&] { return fitCompression(loop, pieces_); });
      report("compression", fit.readings, pieces_, fit.residuals, "m");
      fabric().compression = {fit.points,
                              fromFit("thickness and pressure", fit.readings, fit.residuals)};
      addCompressionParameters(fit.kes);
      if (fit.resilience) resilience = fit.resilience;
    } else if (const auto kes = compressionValues()) {
      naming("compression", [&] { return compressionFromKes(*kes); });
      addCompressionParameters(*kes);
    }
    if (!resilience) return;
    parameter("RC", "", "%", 0.01, *resilience);
    fabric().remarks.push_back("Resilience of compression RC " +
                               base::shortNumber(100.0 * *resilience) +
                               " %, which has no key: compression here is elastic");
  }

  void addCompressionParameters(const KesCompression& kes) {
    parameter("T0", "", "mm", 1e-3, kes.low_pressure_thickness);
    parameter("TM", "", "mm", 1e-3, kes.high_pressure_thickness);
    parameter("WC", "", "gf.cm/cm2", kKesGramPerCentimetre, kes.work);
  }

  /// From KES or FAST values, and the source of them into the fabric.
  std::optional<KesCompression> compressionValues() {
    if (const auto t0 = file_.value("T0"), tm = file_.value("TM"); t0 && tm) {
      std::optional<double> work = file_.value("WC");
      const auto linearity = file_.value("LC");
      if (!work && linearity) work = 0.5 * *linearity * (*t0 - *tm) * kKesHighPressure;
      if (!work) refuse("compression", "has T0 and TM without WC or LC: give one of them");
      const KesCompression kes{*t0, *tm, *work};
      fabric().compression = {kes, from("KES values T0, TM and WC (or LC)")};
      return kes;
    }
    const auto low = file_.value("T2"), high = file_.value("T100");
    if (!low || !high) {
      for (const char* name : {"T0", "TM", "WC", "LC", "T2", "T100"}) {
        if (file_.value(name)) {
          refuse("compression", std::string("has ") + name +
                                    " without the rest: give T0, TM and WC or LC, or T2 and T100");
        }
      }
      return std::nullopt;
    }
    // p = a / (T - core)^3 through both.
    const double ratio = std::cbrt(kFastHighPressure / kFastLowPressure);
    const double core = (ratio * *high - *low) / (ratio - 1.0);
    if (*low <= *high || core < 0.0) {
      refuse("compression", "has T2 " + base::shortNumber(*low) + " m and T100 " +
                                base::shortNumber(*high) +
                                " m; T2 must be greater than T100 and at "
                                "most 3.68 times as much");
    }
    const auto thickness = [&](double pressure) {
      return core + (*low - core) * std::cbrt(kFastLowPressure / pressure);
    };
    const auto work = [&](double to) {  // from infinity
      return 0.5 * kFastLowPressure * std::pow(*low - core, 3) / std::pow(to - core, 2);
    };
    const double t0 = thickness(kKesLowPressure), tm = thickness(kKesHighPressure);
    const KesCompression kes{t0, tm, work(tm) - work(t0)};
    fabric().compression = {kes, from("FAST values T2 and T100; the KES values of van Wyk's law "
                                      "around an incompressible core through both")};
    return kes;
  }

  void addSurface() {
    const ReadingLoop& loop = file_.loop(TesterTest::kSurface);
    std::optional<double> friction = file_.value("MIU"), deviation = file_.value("MMD");
    const bool read = !loop.loading.empty() || !loop.unloading.empty();
    if (read) {
      const SurfaceFit fit = naming("surface", [&] { return fitSurface(loop); });
      friction = fit.friction;
      deviation = fit.friction_deviation;
    }
    if (friction) {
      parameter("MIU", "", "1", 1.0, *friction);
      fabric().friction = {*friction, from(read ? "mean of surface (MIU)" : "value MIU")};
    }
    const auto roughness = file_.value("SMD");
    if (deviation) parameter("MMD", "", "1", 1.0, *deviation);
    if (roughness) parameter("SMD", "", "um", 1e-6, *roughness);
    std::string remark;
    if (roughness) remark += "SMD " + base::shortNumber(*roughness) + " m";
    if (deviation) remark += (remark.empty() ? "MMD " : ", MMD ") + base::shortNumber(*deviation);
    if (remark.empty()) return;
    fabric().remarks.push_back(
        remark + ": for the key surface, which needs the weave or a file of heights, too");
  }

  const TesterFile& file_;
  const int pieces_;
  std::string source_;
  TesterFit result_;
};

}  // namespace

TesterFit fitFabric(const TesterFile& file, const std::string& name, int pieces) {
  return Fitter(file, name, pieces).fit();
}

}  // namespace haptex::material
