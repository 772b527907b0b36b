#include "haptex/studies/extreme_case.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "haptex/base/quoted.h"
#include "haptex/material/compression.h"

namespace haptex::studies {
namespace {

using cloth::IntegrationMethod;

/// Calls with name and reference of every field.
template <typename Case, typename Visit>
void forEachField(Case& extreme, Visit&& visit) {
  visit("seed", extreme.seed);
  visit("kind", extreme.kind);
  visit("method", extreme.method);
  visit("newton_iterations", extreme.newton_iterations);
  visit("cells_u", extreme.cells_u);
  visit("cells_v", extreme.cells_v);
  visit("cell", extreme.cell);
  visit("irregularity", extreme.irregularity);
  visit("needle", extreme.needle);
  visit("taut", extreme.taut);
  visit("strain", extreme.strain);
  visit("density", extreme.density);
  visit("weft", extreme.weft);
  visit("warp", extreme.warp);
  visit("shear", extreme.shear);
  visit("stiffening", extreme.stiffening);
  visit("viscosity", extreme.viscosity);
  visit("bending", extreme.bending);
  visit("shortest_step", extreme.shortest_step);
  visit("longest_step", extreme.longest_step);
  visit("disturbed_steps", extreme.disturbed_steps);
  visit("free_steps", extreme.free_steps);
  visit("magnitude", extreme.magnitude);
  visit("self_collision", extreme.self_collision);
}

template <typename T>
void write(std::ostream& out, const T& value) {
  out << value;
}
void write(std::ostream& out, ExtremeKind kind) { out << nameOf(kind); }
void write(std::ostream& out, IntegrationMethod method) { out << cloth::nameOf(method); }

template <typename T>
bool read(const std::string& text, T& value) {
  std::istringstream in(text);
  return static_cast<bool>(in >> value) && in.eof();
}
bool read(const std::string& text, double& value) {
  std::size_t end = 0;
  value = std::stod(text, &end);
  return end == text.size();
}
bool read(const std::string& text, bool& value) {
  value = text == "1";
  return text == "0" || text == "1";
}
bool read(const std::string& text, ExtremeKind& kind) {
  const auto found = std::find_if(kExtremeKinds.begin(), kExtremeKinds.end(),
                                  [&](const auto& named) { return text == named.name; });
  if (found == kExtremeKinds.end()) return false;
  kind = found->kind;
  return true;
}
bool read(const std::string& text, IntegrationMethod& method) {
  const auto& all = cloth::kIntegrationMethods;
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const auto& named) { return text == named.name; });
  if (found == all.end()) return false;
  method = found->method;
  return true;
}

void drawFabric(RepeatableRandom& random, ExtremeCase& extreme) {
  extreme.density = random.logarithmic(1e-3, 10.0);
  extreme.weft = random.logarithmic(1e-3, 1e7);
  // Anisotropy up to 1e5 within the same bounds.
  const double anisotropy = random.chance(0.5) ? random.logarithmic(1e-5, 1e5) : 1.0;
  extreme.warp = std::clamp(extreme.weft * anisotropy, 1e-3, 1e7);
  extreme.shear = random.logarithmic(0.01, 1.0) * std::min(extreme.weft, extreme.warp);
  extreme.stiffening = random.chance(0.3) ? random.logarithmic(1.0, 100.0) : 1.0;
  extreme.viscosity = random.chance(0.3) ? random.logarithmic(1e-5, 1e-1) : 0.0;
  extreme.bending = random.chance(0.3) ? random.logarithmic(1e-7, 1e-2) : 0.0;
}

void drawMethod(RepeatableRandom& random, ExtremeCase& extreme) {
  // Half of the cases as scenes are by default.
  if (random.chance(0.5)) return;
  if (random.chance(0.1)) {
    extreme.method = cloth::kIntegrationMethods[4 + random.below(4)].method;
    return;
  }
  extreme.method = cloth::kIntegrationMethods[random.below(4)].method;
  constexpr int kSolves[] = {1, 2, 5, 20};
  extreme.newton_iterations = kSolves[random.below(4)];
}

double drawMagnitude(RepeatableRandom& random, ExtremeKind kind) {
  switch (kind) {
    case ExtremeKind::kTimeSteps:
      return random.logarithmic(0.01, 10.0);
    case ExtremeKind::kScrambled:
      return random.logarithmic(0.1, 100.0);
    case ExtremeKind::kAttachmentJump:
      return random.logarithmic(0.01, 10.0);
    case ExtremeKind::kAttachmentSpin:
      return random.logarithmic(1.0, 100.0);
    case ExtremeKind::kFast:
      return random.logarithmic(1.0, 1000.0);
    case ExtremeKind::kGusts:
      return random.logarithmic(1.0, 60.0);
    case ExtremeKind::kFabricChange:
      return random.logarithmic(1e-5, 1e5);
    case ExtremeKind::kFingertips:
      return random.logarithmic(1e-3, 0.2);
    default:
      return 1.0;
  }
}

/// Fingertips live in a loop of 1 kHz with a large-scale layer of tens of Hz, fabrics that people
/// touch, and cells of their size.
void drawTouched(RepeatableRandom& random, ExtremeCase& extreme) {
  extreme.cells_u = extreme.cells_v = 4 + random.below(5);
  extreme.cell = random.uniform(0.01, 0.025);
  extreme.density = random.logarithmic(0.03, 1.0);
  extreme.weft = random.logarithmic(30.0, 1e4);
  extreme.warp = extreme.weft * random.logarithmic(0.1, 10.0);
  extreme.shear = random.logarithmic(0.05, 1.0) * std::min(extreme.weft, extreme.warp);
  extreme.bending = random.logarithmic(1e-6, 1e-4);
  extreme.viscosity = random.logarithmic(1e-4, 1e-2);
  extreme.irregularity = 0.0;
  extreme.shortest_step = extreme.longest_step = 1e-3 * (5 + random.below(36));
  extreme.disturbed_steps = 3 + random.below(4);
  if (!cloth::isImplicit(extreme.method)) extreme.method = IntegrationMethod::kBackwardEuler;
}

material::StrainStressCurve curveOf(double modulus, double stiffening) {
  constexpr double kKnee = 0.05;
  if (stiffening == 1.0) return material::StrainStressCurve::linear(modulus);
  const double at_knee = modulus * kKnee;
  return material::StrainStressCurve::fit(
      {{kKnee, at_knee}, {2.0 * kKnee, at_knee * (1.0 + stiffening)}},
      material::NegativeBranch::kLinear);
}

}  // namespace

const char* nameOf(ExtremeKind kind) {
  for (const NamedExtremeKind& named : kExtremeKinds) {
    if (named.kind == kind) return named.name;
  }
  return "";
}

ExtremeCase drawExtremeCase(std::uint64_t seed) {
  const std::uint64_t index = seed % kExtremeKinds.size();
  return drawExtremeCase(seed, kExtremeKinds[index].kind);
}

ExtremeCase drawExtremeCase(std::uint64_t seed, ExtremeKind kind) {
  RepeatableRandom random(seed);
  ExtremeCase extreme;
  extreme.seed = seed;
  extreme.kind = kind;
  drawMethod(random, extreme);
  extreme.cells_u = 2 + random.below(6);
  extreme.cells_v = 2 + random.below(6);
  if (random.chance(0.05)) extreme.cells_u = extreme.cells_v = 10;
  extreme.cell = random.logarithmic(0.005, 0.1);
  extreme.irregularity = random.chance(0.5) ? random.uniform(0.0, 0.3) : 0.0;
  extreme.taut = random.chance(0.3);
  extreme.strain = random.uniform(0.01, 0.2);
  drawFabric(random, extreme);
  if (kind == ExtremeKind::kSlivers) extreme.needle = random.logarithmic(1e-6, 0.1);
  extreme.longest_step = random.logarithmic(1e-6, 10.0);
  const bool changing = kind == ExtremeKind::kTimeSteps || random.chance(0.5);
  extreme.shortest_step = changing ? random.logarithmic(1e-6, 10.0) : extreme.longest_step;
  if (extreme.shortest_step > extreme.longest_step) {
    std::swap(extreme.shortest_step, extreme.longest_step);
  }
  extreme.disturbed_steps = 1 + random.below(8);
  extreme.free_steps = 20 + random.below(20);
  extreme.magnitude = drawMagnitude(random, kind);
  if (kind == ExtremeKind::kFingertips) drawTouched(random, extreme);
  return extreme;
}

bool allowsSelfCollision(const ExtremeCase& extreme) {
  return cloth::collidesWithItself(extreme.method, false);
}

std::vector<ExtremeCase> drawSelfCollidingCases(std::uint64_t first, std::size_t count) {
  std::vector<ExtremeCase> cases;
  for (std::uint64_t seed = first; cases.size() < count; ++seed) {
    ExtremeCase extreme = drawExtremeCase(seed);
    if (!allowsSelfCollision(extreme)) continue;
    extreme.self_collision = true;
    cases.push_back(extreme);
  }
  return cases;
}

std::string toText(const ExtremeCase& extreme) {
  std::ostringstream out;
  out.precision(17);
  const char* separator = "";
  forEachField(extreme, [&](const char* name, const auto& value) {
    out << separator << name << '=';
    write(out, value);
    separator = " ";
  });
  return out.str();
}

ExtremeCase parseExtremeCase(const std::string& text) {
  ExtremeCase extreme;
  std::istringstream in(text);
  for (std::string word; in >> word;) {
    const std::size_t equals = word.find('=');
    const std::string key = word.substr(0, equals);
    bool known = false, understood = false;
    forEachField(extreme, [&](const char* name, auto& value) {
      if (key != name || equals == std::string::npos) return;
      known = true;
      understood = read(word.substr(equals + 1), value);
    });
    if (!known) throw std::invalid_argument("an extreme case has no field " + base::quoted(key));
    if (!understood) throw std::invalid_argument("'" + word + "' is not a value of the field");
  }
  return extreme;
}

mesh::ClothMesh meshOf(const ExtremeCase& extreme) {
  const double width = extreme.cell * extreme.cells_u, height = extreme.cell * extreme.cells_v;
  mesh::ClothMesh mesh = mesh::makeRectangle(width, height, extreme.cells_u, extreme.cells_v,
                                             mesh::Triangulation::kAlternating);
  RepeatableRandom random(extreme.seed + 1);
  const double stretch = extreme.taut ? 1.0 + extreme.strain : 1.0;
  for (std::size_t i = 0; i < mesh.rest_coordinates.size(); ++i) {
    Eigen::Vector2d& rest = mesh.rest_coordinates[i];
    const int column = static_cast<int>(i) % (extreme.cells_u + 1);
    const int row = static_cast<int>(i) / (extreme.cells_u + 1);
    const bool inner = column > 0 && column < extreme.cells_u && row > 0 && row < extreme.cells_v;
    const double most = extreme.cell * extreme.irregularity;
    if (inner) rest += random.inSquare(-most, most);
    // The first column becomes narrow, whatever irregularity has made of it.
    const double first = column == 0 ? 0.0 : rest.x() - (1.0 - extreme.needle) * extreme.cell;
    if (extreme.needle < 1.0) rest.x() = column == 1 ? extreme.needle * extreme.cell : first;
    mesh.initial_positions[i] = {0.0, stretch * (rest.x() - width / 2.0),
                                 stretch * (rest.y() - height)};
  }
  return mesh;
}

material::Fabric fabricOf(const ExtremeCase& extreme) {
  using material::StrainStressCurve;
  material::Fabric fabric;
  fabric.name = "extreme";
  fabric.areal_density = extreme.density;
  fabric.weft.elastic = curveOf(extreme.weft, extreme.stiffening);
  fabric.warp.elastic = curveOf(extreme.warp, extreme.stiffening);
  fabric.shear.elastic = StrainStressCurve::linear(extreme.shear);
  fabric.weft.viscous = StrainStressCurve::linear(extreme.viscosity * extreme.weft);
  fabric.warp.viscous = StrainStressCurve::linear(extreme.viscosity * extreme.warp);
  fabric.shear.viscous = StrainStressCurve::linear(extreme.viscosity * extreme.shear);
  fabric.bending = material::BendingRigidity{extreme.bending, extreme.bending};
  fabric.friction = 0.2;
  fabric.compression = material::compressionFromPoints({{0.0, 5e-4}, {1e4, 4e-4}});
  return fabric;
}

}  // namespace haptex::studies
