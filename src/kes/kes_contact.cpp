// KES-FB3 and FB4: compression and surface.
#include <cmath>
#include <stdexcept>
#include <vector>

#include "haptex/base/quoted.h"
#include "haptex/contact/sphere_contact.h"
#include "haptex/kes/virtual_kes.h"
#include "haptex/material/compression.h"
#include "haptex/tactile/kes_surface.h"
#include "haptex/tactile/surface.h"

namespace haptex::kes {
namespace {

using Eigen::Vector3d;

// A fingertip as large and hard as this is a plate: over the sample it is flat to 1 nm.
constexpr double kPlateRadius = 1e5;      // m
constexpr double kPlateStiffness = 1e15;  // Pa/m
constexpr int kCells = 10;                // of the sample, along each side

/// A flat sheet at rest around the origin, in the plane x = 0.
struct FlatSample {
  std::vector<Vector3d> positions, velocities;
  std::vector<double> areas;

  explicit FlatSample(double side) {
    const double cell = side / kCells;
    for (int i = 0; i < kCells; ++i) {
      for (int j = 0; j < kCells; ++j) {
        positions.emplace_back(0.0, (i + 0.5) * cell - 0.5 * side, (j + 0.5) * cell - 0.5 * side);
        areas.push_back(cell * cell);
      }
    }
    velocities.assign(positions.size(), Vector3d::Zero());
  }
  contact::Particles particles() const {
    return {positions, velocities, areas, static_cast<int>(positions.size())};
  }
};

/// What a plate feels as it presses on one side of the sample; the other side is held alike.
class Plate {
 public:
  Plate(const material::Fabric& fabric, double side)
      : law_(fabric, {kPlateStiffness, contact::PulpSettings().damping}),
        sample_(side),
        contact_(law_, sample_.positions.size()) {
    plate_.radius = kPlateRadius;
  }
  double freeThickness() const { return 2.0 * law_.halfThickness(); }

  /// Force of the plate on the sample (N) between two plates at a distance (m) that approach each
  /// other with `speed` (m/s).
  double press(double thickness, double speed) {
    plate_.position = {kPlateRadius + 0.5 * thickness, 0.0, 0.0};
    plate_.velocity = {-0.5 * speed, 0.0, 0.0};
    double force = 0.0;
    for (const auto& touched : contact_.evaluate(sample_.particles(), plate_)) {
      force -= touched.force().x();
    }
    return force;
  }

  /// Draws the plate over the sample until all slips: the force along by the force across.
  double slide(double thickness) {
    contact_.clear();
    double along = 0.0, across = 0.0;
    constexpr int kSteps = 200;
    constexpr double kWay = 2e-3;  // m
    for (int i = 0; i <= kSteps; ++i) {
      plate_.position = {kPlateRadius + 0.5 * thickness, kWay * i / kSteps, 0.0};
      plate_.velocity.setZero();
      along = across = 0.0;
      for (const auto& touched : contact_.commit(sample_.particles(), plate_)) {
        if (!touched.slips && i == kSteps) return std::nan("");
        along += touched.friction.y();
        across += touched.normal_force;
      }
    }
    return along / across;
  }

 private:
  contact::ContactLaw law_;
  FlatSample sample_;
  contact::SphereContact contact_;
  contact::Fingertip plate_;
};

/// The thickness at a force (N) while the plates approach at a speed, by bisection.
double thicknessAt(Plate& plate, double force, double speed) {
  double thin = 0.0, thick = plate.freeThickness();
  while (thick - thin > 1e-13) {
    const double middle = 0.5 * (thin + thick);
    (plate.press(middle, speed) > force ? thin : thick) = middle;
  }
  return 0.5 * (thin + thick);
}

/// Pressure (Pa) of the fabric file's curve at a thickness (m).
double curvePressure(const material::Compression& compression, double thickness) {
  return compression.pressure.evaluate(1.0 - thickness / compression.thickness).stress;
}

double curveThickness(const material::Compression& compression, double pressure) {
  double thin = 0.0, thick = compression.thickness;
  while (thick - thin > 1e-13) {
    const double middle = 0.5 * (thin + thick);
    (curvePressure(compression, middle) > pressure ? thin : thick) = middle;
  }
  return 0.5 * (thin + thick);
}

/// Work per area (J/m^2) from the thickness t0 to tm by the midpoint rule.
template <typename Pressure>
double workOf(Pressure pressure, double t0, double tm) {
  constexpr int kParts = 2000;
  double sum = 0.0;
  for (int i = 0; i < kParts; ++i) sum += pressure(t0 + (tm - t0) * (i + 0.5) / kParts);
  return sum * (t0 - tm) / kParts;
}

/// The built surface and the relief that it is made of, in its true size.
struct TestedSurface {
  double roughness;           // m
  double friction_deviation;  // no unit
};

/// What strokes over the surface that the tactile renderer builds find. It keeps of the relief its
/// spectrum, whose power says how high the relief is.
TestedSurface testBuiltSurface(const material::Fabric& fabric) {
  const tactile::Surface built = tactile::buildSurface(fabric);
  tactile::HeightField field = tactile::sampledRelief(*fabric.surface);
  const double scale = std::sqrt(built.small_scale.waves.totalPower() /
                                 tactile::kSpaceOfPeriodic(field).totalPower());
  for (double& height : field.heights) height *= scale;
  const tactile::KesSurface tested = tactile::testSurface(field);
  return {tested.roughness, built.small_scale.friction_per_slope * tested.slope_deviation};
}

}  // namespace

KesResult kesCompression(const material::Fabric& fabric) {
  Plate plate(fabric, std::sqrt(kKesCompressionArea));  // names what the fabric lacks
  const material::Compression& compression = *fabric.compression;
  const auto pressure = [&](double speed) {
    return [&plate, speed](double thickness) {
      return plate.press(thickness, speed) / kKesCompressionArea;
    };
  };
  const auto thickness = [&](double at) {
    return thicknessAt(plate, at * kKesCompressionArea, kKesCompressionSpeed);
  };
  const double t0 = thickness(material::kKesLowPressure);
  const double tm = thickness(material::kKesHighPressure);
  KesResult result;
  constexpr int kPoints = 20;
  for (int i = 0; i <= kPoints; ++i) {
    const double at = t0 + (tm - t0) * i / kPoints;
    result.points.push_back(
        {"compression", "thickness", at, pressure(0.0)(at), curvePressure(compression, at)});
  }
  const double work = workOf(pressure(kKesCompressionSpeed), t0, tm);
  const double returned = workOf(pressure(-kKesCompressionSpeed), t0, tm);
  const double exact_t0 = curveThickness(compression, material::kKesLowPressure);
  const double exact_tm = curveThickness(compression, material::kKesHighPressure);
  const double exact_work =
      workOf([&](double at) { return curvePressure(compression, at); }, exact_t0, exact_tm);
  const auto linearity = [](double of, double thick, double thin) {
    return of / (0.5 * (thick - thin) * material::kKesHighPressure);
  };
  result.parameters = {
      {"LC", "-", linearity(exact_work, exact_t0, exact_tm), linearity(work, t0, tm)},
      {"WC", "gf.cm/cm2", exact_work / kKesGramPerCentimetre, work / kKesGramPerCentimetre},
      {"RC", "%", 100.0, 100.0 * returned / work},
      {"T0", "mm", 1e3 * exact_t0, 1e3 * t0},
      {"TM", "mm", 1e3 * exact_tm, 1e3 * tm}};
  return result;
}

KesResult kesSurface(const material::Fabric& fabric) {
  if (!fabric.surface) {
    throw std::invalid_argument("fabric " + base::quoted(fabric.name) +
                                " has no surface: add the key surface");
  }
  Plate plate(fabric, kKesFrictionSide);
  const TestedSurface tested = testBuiltSurface(fabric);
  KesResult result;
  result.parameters = {
      {"MIU", "-", *fabric.friction, plate.slide(thicknessAt(plate, kKesFrictionLoad, 0.0))},
      {"MMD", "-", fabric.surface->friction_deviation, tested.friction_deviation},
      {"SMD", "um", 1e6 * fabric.surface->roughness, 1e6 * tested.roughness}};
  return result;
}

}  // namespace haptex::kes
