// Cloth of several fabrics: each carries, presses and rubs as it does alone.
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "haptex/base/workload.h"
#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/material/fabric_file.h"
#include "haptex/material/linear_fabric.h"
#include "haptex/oracles/checks/random_checks.h"
#include "haptex/oracles/checks/validation.h"
#include "haptex/oracles/exact/supported_press.h"
#include "haptex/oracles/experiments/contact_scenes.h"
#include "haptex/oracles/experiments/hanging_strip.h"

namespace haptex::oracles {
namespace {

using Eigen::Vector3d;
using material::Fabric;

constexpr double kRubTolerance = 1e-3;

/// Gives all triangles whose middle is beyond a line to fabric 1.
/// @param axis 0: weft, 1: warp @param border m, in rest coordinates
void divide(mesh::ClothMesh& mesh, int axis, double border) {
  mesh.triangle_fabrics.clear();
  for (const auto& [a, b, c] : mesh.triangles) {
    const double middle = (mesh.rest_coordinates[a][axis] + mesh.rest_coordinates[b][axis] +
                           mesh.rest_coordinates[c][axis]) /
                          3.0;
    mesh.triangle_fabrics.push_back(middle > border ? 1 : 0);
  }
}

/// A strip half of one linear fabric, below, and half of another, hangs by its weight.
struct SeriesStrip {
  double half = 0.2;                             // m, length of each
  std::array<double, 2> moduli = {50.0, 200.0};  // N/m, of the lower and the upper half
  std::array<double, 2> densities = {0.3, 0.1};  // kg/m2
  double gravity = 9.81;                         // m/s2
  int cells = base::unlessSanitized(100, 20);    // along both halves
};

/// m: integral of stretch - 1 over a half, by Simpson's rule.
double exactElongationOf(const SeriesStrip& strip, int half) {
  constexpr int kIntervals = 200;
  const auto curve = material::StrainStressCurve::linear(strip.moduli[half]);
  const double hung = half == 0 ? 0.0 : strip.densities[0] * strip.half;  // kg/m
  double sum = 0.0;
  for (int i = 0; i <= kIntervals; ++i) {
    const double below = hung + strip.densities[half] * strip.half * i / kIntervals;
    const double weight = i == 0 || i == kIntervals ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
    sum += weight * (stretchUnder(strip.gravity * below, curve) - 1.0);
  }
  return sum * strip.half / kIntervals / 3.0;
}

/// Hung for 20 s, the elongation of each half. @param name of the lines, without the half
void hang(const SeriesStrip& strip, const std::string& name, const Sink& sink) {
  mesh::ClothMesh mesh = mesh::makeRectangle(0.2 * strip.half, 2.0 * strip.half, strip.cells / 10,
                                             strip.cells, mesh::Triangulation::kAlternating);
  divide(mesh, 1, strip.half);
  std::vector<Fabric> fabrics;
  for (int half = 0; half < 2; ++half) {
    // Viscosity shortens the way to rest.
    fabrics.push_back(material::linearFabric(strip.moduli[half], 0.2 * strip.moduli[half]));
    fabrics.back().areal_density = strip.densities[half];
  }
  cloth::ModelledEffects effects;
  effects.viscosity = true;
  effects.gravity = {0.0, 0.0, -strip.gravity};
  cloth::Cloth cloth(mesh, fabrics, effects);
  cloth::ClothState state = cloth.initialState();
  for (const int particle : sideParticles(mesh, mesh::Side::kTop)) {
    cloth.attach(particle, {state.positions[particle]});
  }
  cloth::StepSettings settings;
  settings.tolerance = 1e-10;
  cloth::Integrator integrator(cloth, settings);
  while (state.time < 20.0) integrator.step(cloth, state, 0.05);
  const auto heightOf = [&](double v) {
    double sum = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < state.positions.size(); ++i) {
      if (std::abs(mesh.rest_coordinates[i].y() - v) > 1e-9) continue;
      sum += state.positions[i].z();
      ++count;
    }
    return sum / count;
  };
  const double weight = (strip.densities[0] + strip.densities[1]) * strip.half * strip.gravity;
  for (int half = 0; half < 2; ++half) {
    const double exact = exactElongationOf(strip, half);
    const double length = heightOf((half + 1) * strip.half) - heightOf(half * strip.half);
    // Rows of alternating cells hang unevenly by the weight of their own, which counts the more the
    // less the half carries.
    const double carried =
        strip.half * strip.gravity *
        (half == 0 ? 0.5 * strip.densities[0] : strip.densities[0] + 0.5 * strip.densities[1]);
    const double tolerance =
        (0.15 * weight / carried + 2.0 * weight / strip.moduli[half]) / (strip.cells * strip.cells);
    sink(base::relativeTo(exact, name + (half == 0 ? "/lower_m" : "/upper_m"), exact,
                          length - strip.half, tolerance));
  }
}

void validateStrips(const Sink& sink) {
  hang({}, "regions/strip", sink);
  SeriesStrip stiff_below;
  stiff_below.moduli = {2000.0, 20.0};
  hang(stiff_below, "regions/strip_stiff_below", sink);
  SeriesStrip light_below;
  light_below.densities = {0.05, 0.4};
  hang(light_below, "regions/strip_light_below", sink);
}

/// A sheet on a plate, of one fabric up to a border and another beyond it, weft along y.
HapticLoopSettings dividedSheet(const Fabric& first, const Fabric& second, double border,
                                double plate_friction) {
  TableSettings table;
  table.fabric = first;
  table.cells = 40;
  table.refinement = base::unlessSanitized(2, 1);
  table.plate_friction = plate_friction;
  HapticLoopSettings settings = sheetOnPlate(table);
  settings.region_fabrics = {second};
  divide(settings.mesh, 0, 0.5 * table.side + border);
  return settings;
}

/// The finger presses 10 mm from the border, on either side of it.
void validatePress(const Fabric& first, const Fabric& second, const Sink& sink) {
  for (const double border : {0.01, -0.01}) {
    const Fabric& under = border > 0.0 ? first : second;
    const contact::ContactLaw law(under);
    const double height = kIndexRadius + law.halfThickness() - 1e-3;
    HapticLoop loop(dividedSheet(first, second, border, 0.2));
    press(loop, height, 0.2);
    const double exact = supportedPressForce(under, law, kIndexRadius, height);
    sink(base::relativeTo(exact, "regions/press/" + under.name, exact, feltByIndex(loop).z(),
                          pressTolerance()));
  }
}

/// The finger rubs from one fabric over the border to the other, on fabric that the plate holds:
/// all that it touches slips, so friction over pressure is the fabric's coefficient.
void validateRub(const Fabric& first, const Fabric& second, const Sink& sink) {
  constexpr double kBorder = 0.01, kSpeed = 0.05, kLength = 0.02, kAlone = 5e-3;  // m, m/s
  constexpr double kHeld = 5.0;  // coefficient of the plate
  HapticLoop loop(dividedSheet(first, second, kBorder, kHeld));
  const double reach = kIndexRadius + contact::ContactLaw(first).halfThickness();
  contact::Fingertip finger = press(loop, reach - 1e-3, 0.1);
  finger.velocity = kSpeed * Vector3d::UnitY();
  std::array<double, 2> drag{}, pressed{};
  while (finger.position.y() < kLength) {
    finger.position += 1e-3 * finger.velocity;
    loop.step({finger, std::nullopt});
    const double from_border = finger.position.y() - kBorder;
    if (std::abs(from_border) < kAlone || finger.position.y() < 2e-3) continue;
    const int side = from_border < 0.0 ? 0 : 1;
    for (const contact::ContactPoint& point :
         loop.layer().contacts()[base::Finger::kIndex].points) {
      drag[side] += point.tangential_force.norm();
      pressed[side] += point.normal_force;
    }
  }
  for (int side = 0; side < 2; ++side) {
    const Fabric& under = side == 0 ? first : second;
    sink(base::relativeTo(*under.friction, "regions/rub/" + under.name, *under.friction,
                          drag[side] / pressed[side], kRubTolerance));
  }
}

}  // namespace

void validateRegions(const std::string& config_directory, const Sink& sink) {
  const Fabric wool = material::loadFabric(config_directory + "/fabrics/wool.yaml");
  const Fabric denim = material::loadFabric(config_directory + "/fabrics/denim.yaml");
  const Fabric poplin = material::loadFabric(config_directory + "/fabrics/cotton_poplin.yaml");
  const Fabric satin = material::loadFabric(config_directory + "/fabrics/polyester_satin.yaml");
  validateStrips(sink);
  validatePress(wool, denim, sink);
  if (!base::kSanitized) validatePress(poplin, satin, sink);
  validateRub(wool, denim, sink);
}

void randomRegions(const std::string&, Random& random, const Sink& sink) {
  for (int i = 0; i < 2; ++i) {
    SeriesStrip strip;
    strip.half = random.uniform(0.1, 0.3);
    for (double& modulus : strip.moduli) modulus = random.logarithmic(20.0, 2000.0);
    for (double& density : strip.densities) density = random.uniform(0.05, 0.4);
    strip.cells = 2 * (base::unlessSanitized(25, 8) + random.below(10));
    CaseName name("regions", "strip");
    name.with("half", strip.half).with("lower", strip.moduli[0]).with("upper", strip.moduli[1]);
    name.with("below", strip.densities[0]).with("above", strip.densities[1]);
    name.with("cells", strip.cells);
    hang(strip, name.text(), sink);
  }
}

}  // namespace haptex::oracles
