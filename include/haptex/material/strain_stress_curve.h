// Strain-stress curves of a fabric as piecewise cubic polynomials.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace haptex::material {

/// One sample of a measured curve: Green-Lagrange strain (no unit) and its energy-conjugate
/// second Piola-Kirchhoff stress (N/m). For a viscous curve: strain rate (1/s) and stress (N/m).
struct CurvePoint {
  double strain;
  double stress;
};

/// Stress (N/m) and its derivative by strain (N/m) at one strain.
struct CurveValue {
  double stress;
  double slope;
};

/// What a fit assumes for negative strains when every sample lies at strain >= 0.
enum class NegativeBranch {
  kLinear,  ///< straight on with the slope at zero: compression of a thread direction
  kOdd,     ///< stress(-e) = -stress(e): shear of a fabric that is alike to both sides
};

/// Checks that a curve can be fitted to the points.
/// @throws std::invalid_argument naming the first offending point by index and value unless every
///   number is finite, strains are strictly increasing, one of them is not 0, and the stress at
///   strain 0 (if sampled) is 0
void requireFitPoints(const std::vector<CurvePoint>& points);

/// Stress as a C1 piecewise cubic function of strain, zero at zero strain.
///
/// Between the outermost knots each interval [knot_i, knot_i+1] carries
///   stress(e) = c0 + c1 x + c2 x^2 + c3 x^3,  x = e - knot_i.
/// Outside of the outermost knots the curve continues as a straight line with the value and slope
/// that it has there, so it stays C1.
/// That covers both ends of a measurement: beyond the last sample the fabric keeps its last
/// measured stiffness, and below strain 0 (compression, which tensile testers do not measure) it
/// keeps its initial one. With stress = k e the compressive force per rest width l k (l^2 - 1)/2
/// has its maximum 0.192 k at stretch l = 0.577 and returns to zero at collapse (l = 0): a sheet
/// gives way in the plane before that, as real fabric does by buckling.
///
/// Evaluation allocates nothing and takes O(1) time: bins no wider than the narrowest interval lead
/// to the right one within three comparisons. (Their number is limited to kMaxBins, so a curve
/// whose intervals differ in width by a factor of hundreds takes a few more.) It returns NaN for a
/// strain that is NaN or infinite.
class StrainStressCurve {
 public:
  /// The curve that is zero everywhere (no stress, no slope).
  StrainStressCurve();

  /// stress = modulus * strain.
  /// @param modulus N/m (elastic) or N.s/m (viscous), finite and >= 0
  /// @throws std::invalid_argument naming the value otherwise
  static StrainStressCurve linear(double modulus);

  /// A curve from its intervals and coefficients.
  /// @param knots        n+1 strictly increasing, finite strains, n >= 1
  /// @param coefficients n rows (c0, c1, c2, c3) as in the class description, finite
  /// @throws std::invalid_argument naming the first offending knot or coefficient by index and
  /// value if sizes or order are wrong, a number is not finite, stress or slope jump at an inner
  /// knot by more than kJumpTolerance of its largest magnitude at the knots, the stress at zero
  /// strain is not zero to the same tolerance, or the numbers are too large for double arithmetic
  static StrainStressCurve fromPolynomials(const std::vector<double>& knots,
                                           const std::vector<std::array<double, 4>>& coefficients);

  /// The monotone C1 cubic interpolant of measured points (Fritsch and Carlson 1980, with the
  /// weighted harmonic mean slopes of Fritsch and Butland 1984): it passes through every point and
  /// rises, falls or stays level between two neighbours exactly as they do. The slope at either
  /// end is that of the outermost interval. The origin is added if the points do not contain it.
  /// @param points at least one with strain != 0, strains strictly increasing, all finite,
  ///   stress 0 at strain 0
  /// @throws std::invalid_argument as requireFitPoints(), or if the numbers are too large for
  ///   double arithmetic
  static StrainStressCurve fit(std::vector<CurvePoint> points, NegativeBranch negative_branch);

  /// Stress (N/m) and slope (N/m) at `strain`.
  CurveValue evaluate(double strain) const {
    const Segment& segment = segments_[segmentIndex(strain)];
    const double x = strain - segment.begin;
    const auto& c = segment.coefficients;
    return {c[0] + x * (c[1] + x * (c[2] + x * c[3])), c[1] + x * (2.0 * c[2] + x * 3.0 * c[3])};
  }

  /// Energy per rest area (J/m^2): the integral of stress from 0 to `strain`.
  double energy(double strain) const {
    const std::size_t segment = segmentIndex(strain);
    return segments_[segment].energy_at_begin + energyFromBegin(segment, strain);
  }

  /// The curve whose stress is `factor` times this one's. @param factor finite, not checked
  StrainStressCurve scaledBy(double factor) const;

  /// True if the stress is zero for every strain.
  bool isZero() const;

  /// The smallest slope anywhere (N/m): below 0 by more than rounding (kJumpTolerance of the
  /// largest slope) if the curve falls somewhere.
  double minimumSlope() const;

  const std::vector<double>& knots() const { return knots_; }
  /// Outermost knots: outside of them the curve is a straight line.
  double firstKnot() const;
  double lastKnot() const;

  static constexpr double kJumpTolerance = 1e-9;
  static constexpr std::size_t kMaxBins = 1024;

 private:
  struct Segment {
    double begin;                        // strain at x = 0
    std::array<double, 4> coefficients;  // of the local cubic
    double energy_at_begin;              // J/m^2
  };

  StrainStressCurve(const std::vector<double>& knots,
                    const std::vector<std::array<double, 4>>& coefficients);

  double energyFromBegin(std::size_t segment, double strain) const {
    const std::array<double, 4>& c = segments_[segment].coefficients;
    const double x = strain - segments_[segment].begin;
    return x * (c[0] + x * (0.5 * c[1] + x * (1.0 / 3.0 * c[2] + x * 0.25 * c[3])));
  }
  void integrateEnergy();
  void makeBins();

  // Only for first knot <= strain <= last knot. Rises with the strain in floating point too,
  // because rounding is monotone; makeBins() relies on that.
  std::size_t binIndex(double strain) const {
    return static_cast<std::size_t>((strain - knots_.front()) * bins_per_strain_);
  }
  std::size_t segmentIndex(double strain) const;

  std::vector<Segment> segments_;  // line before the first knot, intervals, line after the last
  std::vector<double> knots_;
  std::vector<std::size_t> first_segment_of_bin_;  // uniform bins from first to last knot
  double bins_per_strain_ = 0.0;
};

inline std::size_t StrainStressCurve::segmentIndex(double strain) const {
  if (!(strain >= knots_.front())) return 0;  // NaN too
  if (strain >= knots_.back()) return knots_.size();
  std::size_t index = first_segment_of_bin_[binIndex(strain)];
  while (strain >= knots_[index]) ++index;
  return index;
}

}  // namespace haptex::material
