// Generated cases of cloth at the extremes: what a case is, how it is drawn from a seed, and its
// form as text.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "haptex/base/repeatable_random.h"
#include "haptex/cloth/dynamics/step.h"
#include "haptex/material/fabric.h"
#include "haptex/mesh/mesh.h"

namespace haptex::studies {

using base::RepeatableRandom;

/// What disturbs the cloth. It is at rest before.
enum class ExtremeKind {
  kTimeSteps,       ///< a push; then steps that change by orders of magnitude
  kScrambled,       ///< every free particle is moved at random
  kCollapsed,       ///< all free particles on a point or a line
  kMirrored,        ///< upside down, left to right, or drawn through itself
  kSlivers,         ///< needles at rest, and elements without area in the state
  kAttachmentJump,  ///< what holds the cloth jumps by up to metres and back
  kAttachmentSpin,  ///< what holds it turns by up to 100 revolutions per second
  kFast,            ///< velocities of up to 1000 m/s
  kGusts,           ///< wind of up to 60 m/s that comes and goes
  kFabricChange,    ///< another fabric from one step to the next, and back
  kFingertips,      ///< that teleport, appear inside of the cloth and pinch beyond the device
};

struct NamedExtremeKind {
  const char* name;
  ExtremeKind kind;
};

/// Every kind once.
inline constexpr std::array<NamedExtremeKind, 11> kExtremeKinds = {{
    {"time_steps", ExtremeKind::kTimeSteps},
    {"scrambled", ExtremeKind::kScrambled},
    {"collapsed", ExtremeKind::kCollapsed},
    {"mirrored", ExtremeKind::kMirrored},
    {"slivers", ExtremeKind::kSlivers},
    {"attachment_jump", ExtremeKind::kAttachmentJump},
    {"attachment_spin", ExtremeKind::kAttachmentSpin},
    {"fast", ExtremeKind::kFast},
    {"gusts", ExtremeKind::kGusts},
    {"fabric_change", ExtremeKind::kFabricChange},
    {"fingertips", ExtremeKind::kFingertips},
}};

const char* nameOf(ExtremeKind kind);

/// Everything that defines a case. A sheet of square cells, in the plane x = 0, that hangs by its
/// top edge under gravity, or is held taut at all sides without. What is drawn particle by
/// particle or step by step comes from `seed`, so that a case is what its fields say.
struct ExtremeCase {
  std::uint64_t seed = 0;
  ExtremeKind kind = ExtremeKind::kTimeSteps;
  cloth::IntegrationMethod method = cloth::IntegrationMethod::kBackwardEuler;
  int newton_iterations = 1;
  int cells_u = 2;
  int cells_v = 2;
  double cell = 0.05;           ///< m
  double irregularity = 0.0;    ///< of inner rest coordinates, in cells, up to 0.3
  double needle = 1.0;          ///< width of the first column in cells
  bool taut = false;            ///< held at all sides, strained by `strain`; else it hangs
  double strain = 0.05;         ///< of a taut sheet
  double density = 0.1;         ///< kg/m^2
  double weft = 100.0;          ///< N/m
  double warp = 100.0;          ///< N/m
  double shear = 50.0;          ///< N/m
  double stiffening = 1.0;      ///< slope beyond 5 % of strain over that below
  double viscosity = 0.0;       ///< s: viscous over elastic modulus
  double bending = 0.0;         ///< N.m; 0: not modelled
  double shortest_step = 1e-3;  ///< s
  double longest_step = 1e-3;   ///< s; steps are drawn between the two
  int disturbed_steps = 5;      ///< of the disturbance, if that lasts
  int free_steps = 10;          ///< after the disturbance
  /// Of the disturbance: cells of displacement, m of a jump, revolutions per second, m/s, factor of
  /// another fabric, m of a fingertip's leap.
  double magnitude = 1.0;
  bool self_collision = false;  ///< only with backward Euler; drawn cases are without
};

/// @param seed that the whole case is drawn from, the same on every machine
ExtremeCase drawExtremeCase(std::uint64_t seed);
ExtremeCase drawExtremeCase(std::uint64_t seed, ExtremeKind kind);
/// Whether its cloth may collide with itself: the integrator knows how.
bool allowsSelfCollision(const ExtremeCase& extreme);
/// From successive seeds on, every drawn case that allows it, with self_collision.
/// @param first seed @param count of cases
std::vector<ExtremeCase> drawSelfCollidingCases(std::uint64_t first, std::size_t count);

/// One line of "name=value" for every field, which parseExtremeCase() reads back to the bit.
std::string toText(const ExtremeCase& extreme);
/// Fields that are not in the text keep their defaults.
/// @throws std::invalid_argument naming a field that does not exist or a value that is none
ExtremeCase parseExtremeCase(const std::string& text);

/// The sheet of a case, with initial positions as `taut` says.
mesh::ClothMesh meshOf(const ExtremeCase& extreme);
/// With everything that a fingertip needs to know.
material::Fabric fabricOf(const ExtremeCase& extreme);

}  // namespace haptex::studies
