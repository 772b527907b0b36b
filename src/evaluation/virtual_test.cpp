#include "haptex/evaluation/virtual_test.h"

#include <cmath>
#include <functional>
#include <random>
#include <stdexcept>

#include "haptex/cloth/cloth.h"
#include "haptex/cloth/integrator.h"
#include "haptex/evaluation/quantity.h"
#include "haptex/material/strain_measures.h"

namespace haptex::evaluation {
namespace {

using cloth::Cloth;
using cloth::ClothState;
using Eigen::Vector2d;
using Eigen::Vector3d;

// 2500 elements, longer across the jaws than along, like the sample.
constexpr int kCellsAlongJaw = 50;
constexpr int kCellsBetweenJaws = 25;

/// Cloth in the plane x = 0 that goes from one static equilibrium to the next.
class Tester {
 public:
  Tester(cloth::ClothMesh mesh, const material::Fabric& fabric)
      : cloth_(std::move(mesh), fabric, {}),
        state_(cloth_.initialState()),
        integrator_(cloth_, settings()) {}

  const cloth::ClothMesh& mesh() const { return cloth_.mesh(); }

  /// Holds these particles at `place` of their rest coordinates, moves the others there too but for
  /// a random disturbance, and lets them find the equilibrium.
  void equilibrate(const std::vector<int>& held, const std::function<Vector3d(Vector2d)>& place) {
    std::normal_distribution<double> disturbance(0.0, 2e-5);  // m
    for (std::size_t i = 0; i < cloth_.particleCount(); ++i) {
      state_.positions[i] = place(mesh().rest_coordinates[i]) +
                            Vector3d(0.0, disturbance(random_), disturbance(random_));
    }
    cloth_.releaseAll();
    for (int particle : held) {
      cloth::AttachmentPath path;
      path.start = place(mesh().rest_coordinates[particle]);
      cloth_.attach(particle, path);
    }
    // Inertia over a step as long as this is far below the stiffness: backward Euler's fixed point
    // is the static equilibrium itself.
    constexpr double kTimeStep = 1.0;
    constexpr int kMostSteps = 60;
    constexpr double kUnbalanced = 1e-9;  // of the largest force
    constexpr double kNoForce = 1e-11;    // N, near the rounding of the stiffest elements
    for (int i = 0; i < kMostSteps; ++i) {
      state_.velocities.assign(cloth_.particleCount(), Vector3d::Zero());
      integrator_.step(cloth_, state_, kTimeStep);
      cloth_.computeForces(state_, forces_);
      if (largestFreeForce() <= std::max(kUnbalanced * largestForce(), kNoForce)) return;
    }
    throw std::runtime_error("the virtual test did not reach its equilibrium");
  }

  /// The force that holds a particle (N).
  Vector3d reaction(int particle) const { return -forces_[particle]; }

 private:
  static cloth::StepSettings settings() {
    cloth::StepSettings settings;
    settings.solver = cloth::LinearSolverMethod::kCholesky;
    settings.tolerance = 1e-9;
    settings.newton_iterations = 100;
    settings.newton_tolerance = 1e-13;
    return settings;
  }
  double largestForce() const {
    double largest = 0.0;
    for (const Vector3d& force : forces_) largest = largerOrNaN(largest, force.norm());
    return largest;
  }
  double largestFreeForce() const {
    double largest = 0.0;
    for (std::size_t i = 0; i < forces_.size(); ++i) {
      if (!cloth_.attachments()[i]) largest = largerOrNaN(largest, forces_[i].norm());
    }
    return largest;
  }

  Cloth cloth_;
  ClothState state_;
  cloth::Integrator integrator_;
  std::vector<Vector3d> forces_;
  std::mt19937 random_{1};
};

}  // namespace

cloth::ClothMesh irregularRectangle(double width, double height, int cells_u, int cells_v,
                                    unsigned seed) {
  cloth::ClothMesh mesh =
      cloth::makeRectangle(width, height, cells_u, cells_v, cloth::Triangulation::kAlternating);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> part(-0.3, 0.3);
  for (int j = 1; j < cells_v; ++j) {
    for (int i = 1; i < cells_u; ++i) {
      const Vector2d shift(part(random) * width / cells_u, part(random) * height / cells_v);
      const int particle = j * (cells_u + 1) + i;
      mesh.rest_coordinates[particle] += shift;
      mesh.initial_positions[particle] += Vector3d(0.0, shift.x(), shift.y());
    }
  }
  return mesh;
}

std::vector<Reading> tensileTest(const material::Fabric& fabric, Direction direction,
                                 const std::vector<double>& strains) {
  const bool weft = direction == Direction::kWeft;
  Tester tester(
      weft ? irregularRectangle(kSampleLength, kSampleWidth, kCellsBetweenJaws, kCellsAlongJaw, 2)
           : irregularRectangle(kSampleWidth, kSampleLength, kCellsAlongJaw, kCellsBetweenJaws, 2),
      fabric);
  const std::vector<int> jaw =
      sideParticles(tester.mesh(), weft ? cloth::Side::kRight : cloth::Side::kTop);
  std::vector<int> held =
      sideParticles(tester.mesh(), weft ? cloth::Side::kLeft : cloth::Side::kBottom);
  held.insert(held.end(), jaw.begin(), jaw.end());

  std::vector<Reading> readings;
  for (double strain : strains) {
    const double stretch = 1.0 + strain;
    tester.equilibrate(held, [&](const Vector2d& rest) {
      return weft ? Vector3d(0.0, stretch * rest.x(), rest.y())
                  : Vector3d(0.0, rest.x(), stretch * rest.y());
    });
    double force = 0.0;
    for (int particle : jaw) force += tester.reaction(particle)[weft ? 1 : 2];
    readings.push_back({strain, force});
  }
  return readings;
}

std::vector<Reading> shearTest(const material::Fabric& fabric, const std::vector<double>& shears) {
  Tester tester(
      irregularRectangle(kSampleWidth, kSampleLength, kCellsAlongJaw, kCellsBetweenJaws, 3),
      fabric);
  const std::vector<int> jaw = sideParticles(tester.mesh(), cloth::Side::kTop);
  std::vector<int> held = jaw;
  for (cloth::Side side : {cloth::Side::kBottom, cloth::Side::kLeft, cloth::Side::kRight}) {
    const std::vector<int> particles = sideParticles(tester.mesh(), side);
    held.insert(held.end(), particles.begin(), particles.end());
  }
  std::vector<Reading> readings;
  for (double shear : shears) {
    tester.equilibrate(held, [&](const Vector2d& rest) {
      return Vector3d(0.0, rest.x() + shear * rest.y(), rest.y());
    });
    // The corners also carry the guides of the sides: the force on the whole jaw follows from the
    // particles between them, which hold all of it but half a cell at either end.
    double force = 0.0;
    for (std::size_t i = 1; i + 1 < jaw.size(); ++i) force += tester.reaction(jaw[i]).y();
    readings.push_back({shear, force * kCellsAlongJaw / (kCellsAlongJaw - 1.0)});
  }
  return readings;
}

double exactTensileForce(const material::Fabric& fabric, Direction direction, double strain) {
  const material::MembraneCurves& curves =
      direction == Direction::kWeft ? fabric.weft : fabric.warp;
  const double green = material::greenStrain(strain);
  return kSampleWidth * material::forcePerWidth(curves.elastic.evaluate(green).stress, green);
}

double exactShearForce(const material::Fabric& fabric, double shear) {
  return kSampleWidth * (fabric.shear.elastic.evaluate(shear).stress +
                         shear * fabric.warp.elastic.evaluate(0.5 * shear * shear).stress);
}

}  // namespace haptex::evaluation
