// At equal computing time, how far does a hanging sheet stretch here and in Bullet's soft bodies?
// The sheet is that of the HAPTEX performance test of 2005: 0.5 m square, 0.1 kg/m2, modulus
// 100 N/m, attached along its upper edge. Two questions of each solver and setting:
//   time        CPU seconds per simulated second, in the first second of a fall from the horizontal
//               (the cost of ours depends on the motion);
//   elongation  of the sheet at rest under its own weight, in %, and as `error` its distance from
//               the exact 0.2440587 %. Damping shortens the way there and does not change the
//               place.
//
// Bullet has two solvers for cloth:
//   bullet_links       positions projected onto the rest lengths of links along the sides and one
//                      diagonal of square cells, N iterations per step. A link's stiffness is its
//                      material's m_kLST in [0, 1], a share of each projection: it has no modulus
//                      in N/m. Here it is 1, the stiffest, which an endless number of iterations
//                      would make inextensible (error -100 %). What stiffness there is comes from
//                      the number of iterations and of steps, and changes with the mesh.
//   bullet_deformable  springs with a stiffness in N/m (btDeformableMassSpringForce), along the
//                      sides only, so that nothing but the vertical ones carries the weight; the
//                      stiffness is the modulus times cells over particles, so that the columns add
//                      up to the sheet's. Elastic forces are explicit and damping is implicit, and
//                      that is only stable with a damping of about stiffness times time step, which
//                      it has here, in both questions; 10082 triangles at 12.5 ms come apart
//                      all the same. (With setImplicit(true) Debian's 3.24 leaves
//                      the sheet where it is, whatever the scale of masses and stiffnesses.) Force
//                      is linear in the engineering strain: `error` is the distance from the
//                      0.24525 % that are exact then.
// Both compute in single precision, as Debian builds them, and have no collisions to look for.
// Their particles have equal masses, as Bullet gives them. Ours: tolerance 1e-4 and one solve per
// stage.
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableGravityForce.h>
#include <BulletSoftBody/btDeformableMassSpringForce.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btSoftBodyHelpers.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <cmath>
#include <ctime>
#include <functional>
#include <memory>
#include <string>

#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/oracles/experiments/hanging_strip.h"
#include "tab_lines.h"

namespace {

using namespace haptex;

constexpr oracles::HangingStrip kSheet = {0.5, 100.0, 0.1, 9.81};
constexpr double kFall = 1.0;  // s, simulated

double cpuSeconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// A sheet in either simulator.
class Sheet {
 public:
  virtual ~Sheet() = default;
  virtual void step() = 0;
  /// Mean relative elongation of the columns.
  virtual double elongation() const = 0;
};

enum class Start { kHanging, kHorizontal };

// ---- Bullet.

enum class BulletSolver { kLinks, kDeformable };

class BulletSheet : public Sheet {
 public:
  BulletSheet(BulletSolver solver, int cells, double time_step, int iterations, Start start)
      : particles_(cells + 1), time_step_(static_cast<btScalar>(time_step)) {
    if (solver == BulletSolver::kLinks) {
      world_ = std::make_unique<btSoftRigidDynamicsWorld>(&dispatcher_, &broadphase_,
                                                          &links_solver_, &configuration_);
    } else {
      deformable_constraints_.setDeformableSolver(&deformable_solver_);
      auto world = std::make_unique<btDeformableMultiBodyDynamicsWorld>(
          &dispatcher_, &broadphase_, &deformable_constraints_, &configuration_,
          &deformable_solver_);
      world_ = std::move(world);
    }
    const btVector3 gravity(0, 0, static_cast<btScalar>(-kSheet.gravity));
    world_->setGravity(gravity);
    info_.m_gravity = gravity;
    info_.air_density = info_.water_density = 0;
    info_.m_broadphase = &broadphase_;
    info_.m_dispatcher = &dispatcher_;
    info_.m_sparsesdf.Initialize();
    const auto size = static_cast<btScalar>(kSheet.length);
    const btVector3 across(0, size, 0);
    const btVector3 down =
        start == Start::kHanging ? btVector3(0, 0, -size) : btVector3(size, 0, 0);
    body_ =
        btSoftBodyHelpers::CreatePatch(info_, btVector3(0, 0, 0), across, down, across + down,
                                       particles_, particles_, 0, solver == BulletSolver::kLinks);
    body_->setTotalMass(
        static_cast<btScalar>(kSheet.areal_density * kSheet.length * kSheet.length));
    for (int i = 0; i < particles_; ++i) body_->setMass(i, 0);  // the first row is held
    body_->setActivationState(DISABLE_DEACTIVATION);
    const double decay = start == Start::kHanging ? 10.0 : 0.0;  // 1/s
    body_->m_cfg.piterations = iterations;
    body_->m_cfg.kDP = static_cast<btScalar>(1.0 - std::exp(-decay * time_step));
    body_->m_materials[0]->m_kLST = 1;
    if (solver == BulletSolver::kLinks) {
      static_cast<btSoftRigidDynamicsWorld*>(world_.get())->addSoftBody(body_);
    } else {
      body_->m_cfg.collisions = 0;
      auto* world = static_cast<btDeformableMultiBodyDynamicsWorld*>(world_.get());
      world->addSoftBody(body_);
      const double stiffness = kSheet.modulus * cells / particles_;
      const double damping = stiffness * time_step;  // N.s/m
      springs_ = std::make_unique<btDeformableMassSpringForce>(static_cast<btScalar>(stiffness),
                                                               static_cast<btScalar>(damping));
      weight_ = std::make_unique<btDeformableGravityForce>(gravity);
      world->addForce(body_, springs_.get());
      world->addForce(body_, weight_.get());
    }
  }
  ~BulletSheet() override {
    world_->removeCollisionObject(body_);
    delete body_;
  }
  BulletSheet(const BulletSheet&) = delete;
  BulletSheet& operator=(const BulletSheet&) = delete;

  void step() override { world_->stepSimulation(time_step_, 1, time_step_); }

  double elongation() const override {
    double drop = 0.0;
    for (int i = 0; i < particles_; ++i) {
      drop -= body_->m_nodes[(particles_ - 1) * particles_ + i].m_x.z() / particles_;
    }
    return drop / kSheet.length - 1.0;
  }

 private:
  int particles_;  // along an edge
  btScalar time_step_;
  btSoftBodyRigidBodyCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btDeformableBodySolver deformable_solver_;
  btSequentialImpulseConstraintSolver links_solver_;
  btDeformableMultiBodyConstraintSolver deformable_constraints_;
  btSoftBodyWorldInfo info_;
  std::unique_ptr<btDeformableMassSpringForce> springs_;
  std::unique_ptr<btDeformableGravityForce> weight_;
  std::unique_ptr<btDynamicsWorld> world_;
  btSoftBody* body_ = nullptr;
};

// ---- Ours.

material::Fabric fabric() {
  using material::StrainStressCurve;
  material::Fabric fabric;
  fabric.areal_density = kSheet.areal_density;
  // Viscosity near the critical damping of the slowest longitudinal vibration.
  const double viscosity = 0.01 * kSheet.modulus;
  fabric.weft.elastic = fabric.warp.elastic = StrainStressCurve::linear(kSheet.modulus);
  fabric.shear.elastic = StrainStressCurve::linear(0.5 * kSheet.modulus);
  fabric.weft.viscous = fabric.warp.viscous = StrainStressCurve::linear(viscosity);
  fabric.shear.viscous = StrainStressCurve::linear(0.5 * viscosity);
  return fabric;
}

cloth::Cloth clothOf(int cells, Start start) {
  mesh::ClothMesh mesh = mesh::makeRectangle(kSheet.length, kSheet.length, cells, cells,
                                             mesh::Triangulation::kAlternating);
  if (start == Start::kHorizontal) {
    for (Eigen::Vector3d& position : mesh.initial_positions) {
      position = {-position.z(), position.y(), 0.0};
    }
  }
  cloth::ModelledEffects effects;
  effects.viscosity = start == Start::kHanging;
  effects.gravity = {0.0, 0.0, -kSheet.gravity};
  return {std::move(mesh), fabric(), effects};
}

class OurSheet : public Sheet {
 public:
  OurSheet(cloth::IntegrationMethod method, int cells, double time_step, Start start)
      : cloth_(clothOf(cells, start)),
        state_(cloth_.initialState()),
        integrator_(cloth_, settingsOf(method)),
        time_step_(time_step) {
    for (int particle : sideParticles(cloth_.mesh(), mesh::Side::kTop)) {
      cloth::AttachmentPath place;
      place.start = state_.positions[particle];
      cloth_.attach(particle, place);
    }
  }
  void step() override { integrator_.step(cloth_, state_, time_step_); }
  double elongation() const override {
    const std::vector<int> bottom = sideParticles(cloth_.mesh(), mesh::Side::kBottom);
    double drop = 0.0;
    for (int particle : bottom) drop -= state_.positions[particle].z() / bottom.size();
    return drop / kSheet.length - 1.0;
  }

 private:
  static cloth::StepSettings settingsOf(cloth::IntegrationMethod method) {
    cloth::StepSettings settings;
    settings.method = method;
    settings.tolerance = 1e-4;
    return settings;
  }
  cloth::Cloth cloth_;
  cloth::ClothState state_;
  cloth::Integrator integrator_;
  double time_step_;
};

// ---- The comparison.

using Make = std::function<std::unique_ptr<Sheet>(int cells, double time_step, Start start)>;

/// @param settling s, simulated, until the sheet hangs at rest
/// @param exact    elongation by its law of elasticity
void compare(const std::string& name, double milliseconds, int cells, double settling, double exact,
             const Make& make) {
  constexpr double kAverage = 0.1;   // of the settling, of which the elongation is the mean
  constexpr double kFarthest = 2.0;  // lengths, of the free edge; beyond it the sheet came apart
  const double h = 1e-3 * milliseconds;
  const std::string of = name + "_h" + (milliseconds < 2.0 ? "1ms" : "12.5ms") + "/" +
                         std::to_string(2 * cells * cells);
  const std::unique_ptr<Sheet> falling = make(cells, h, Start::kHorizontal);
  const int steps = static_cast<int>(std::lround(kFall / h));
  const double begin = cpuSeconds();
  for (int i = 0; i < steps; ++i) falling->step();
  const double seconds = cpuSeconds() - begin;
  if (std::abs(falling->elongation() + 1.0) < kFarthest) {
    bench::printLine("bullet/time/" + of, seconds / (steps * h), "s/s");
  } else {
    std::fprintf(stderr, "%s: the falling sheet has come apart\n", of.c_str());
  }

  const std::unique_ptr<Sheet> hanging = make(cells, h, Start::kHanging);
  double elongation = 0.0;
  const int all = static_cast<int>(std::lround(settling / h));
  const int averaged = static_cast<int>(std::ceil(kAverage * all));
  for (int i = 0; i < all; ++i) {
    hanging->step();
    if (i >= all - averaged) elongation += hanging->elongation() / averaged;
  }
  if (!(std::abs(elongation) < kFarthest)) {
    std::fprintf(stderr, "%s: the hanging sheet has come apart\n", of.c_str());
    return;
  }
  bench::printLine("bullet/elongation/" + of, 100.0 * elongation, "%");
  bench::printLine("bullet/error/" + of, 100.0 * (elongation / exact - 1.0), "% of the exact");
}

void compareBullet(BulletSolver solver, int iterations, double milliseconds, int cells) {
  constexpr double kSettling = 2.0;
  const std::string name = solver == BulletSolver::kLinks
                               ? "bullet_links_" + std::to_string(iterations) + "_iterations"
                               : "bullet_deformable";
  const double linear =
      0.5 * kSheet.areal_density * kSheet.gravity * kSheet.length / kSheet.modulus;
  const double exact =
      solver == BulletSolver::kDeformable ? linear : oracles::exactElongation(kSheet);
  compare(name, milliseconds, cells, kSettling, exact, [&](int count, double h, Start start) {
    return std::make_unique<BulletSheet>(solver, count, h, iterations, start);
  });
}

void compareOurs(const char* name, cloth::IntegrationMethod method, double milliseconds,
                 int cells) {
  constexpr double kSettling = 0.5;
  const double exact = oracles::exactElongation(kSheet);
  compare(name, milliseconds, cells, kSettling, exact, [&](int count, double h, Start start) {
    return std::make_unique<OurSheet>(method, count, h, start);
  });
}

}  // namespace

int main() {
  for (int cells : {32, 71}) {
    for (int iterations : {10, 50, 200}) {
      compareBullet(BulletSolver::kLinks, iterations, 12.5, cells);
    }
    compareBullet(BulletSolver::kLinks, 10, 1.0, cells);
    if (cells < 50) compareBullet(BulletSolver::kLinks, 50, 1.0, cells);
    for (double milliseconds : {12.5, 1.0}) {
      compareBullet(BulletSolver::kDeformable, 0, milliseconds, cells);
    }
    for (double milliseconds : {12.5, 1.0}) {
      compareOurs("ours_backward_euler", cloth::IntegrationMethod::kBackwardEuler, milliseconds,
                  cells);
      compareOurs("ours_tr_bdf2", cloth::IntegrationMethod::kTrBdf2, milliseconds, cells);
    }
  }
}
