#include "haptex/studies/feature_scenes.h"

#include <Eigen/Geometry>

#include "haptex/base/constants.h"

namespace haptex::studies {
namespace {

using Eigen::Vector3d;

constexpr double kSize = 0.2;  // m
constexpr int kTouched = 200;  // point loads of two fingertips with refined patches

void describeNothing(FeatureScene& /*scene*/) {}

void describeViscosity(FeatureScene& scene) {
  scene.fabric.weft.viscous = material::StrainStressCurve::linear(2.0);
  scene.fabric.warp.viscous = material::StrainStressCurve::linear(4.0);
  scene.fabric.shear.viscous = material::StrainStressCurve::linear(0.5);
}

void describeMembraneHysteresis(FeatureScene& scene) {
  scene.fabric.resilience = {0.6, 0.65};
  scene.fabric.shear_hysteresis = {1.0, 2.0};
}

void describeBending(FeatureScene& scene) { scene.fabric.bending = {1e-5, 1.5e-5}; }

void describeQuadraticBending(FeatureScene& scene) {
  describeBending(scene);
  scene.scene.effects.bending_settings.model = cloth::BendingModel::kQuadratic;
}

void describeHysteresis(FeatureScene& scene) {
  describeBending(scene);
  scene.fabric.bending_hysteresis = {3e-4, 4e-4};
}

void describeContraction(FeatureScene& scene) { scene.fabric.contraction = 0.2; }

void describeBall(FeatureScene& scene, const Vector3d& place) {
  mesh::Obstacle ball{"ball", mesh::ObstacleSphere{0.04}, Eigen::Isometry3d::Identity()};
  ball.pose.translation() = place;
  scene.scene.obstacles = {ball};
  scene.fabric.friction = 0.3;
}

void describeFarObstacle(FeatureScene& scene) { describeBall(scene, {10.0, 0.0, 0.0}); }

/// In the way of the part below the bar, which follows it.
void describeTouchedObstacle(FeatureScene& scene) { describeBall(scene, {0.042, 0.0, -0.045}); }

void describeFingers(FeatureScene& scene) {
  scene.fabric.friction = 0.3;
  scene.fabric.compression = {1e-3, material::StrainStressCurve::linear(1e4)};
}

void listGravity(FeatureScene& scene) {
  scene.scene.effects.gravity = {0.0, 0.0, -base::kStandardGravity};
}
void listViscosity(FeatureScene& scene) { scene.scene.effects.viscosity = true; }
void listMembraneHysteresis(FeatureScene& scene) { scene.scene.effects.membrane_hysteresis = true; }
void listBending(FeatureScene& scene) { scene.scene.effects.bending = true; }
void listHysteresis(FeatureScene& scene) {
  scene.scene.effects.bending = scene.scene.effects.bending_hysteresis = true;
}
void listContraction(FeatureScene& scene) { scene.scene.effects.contraction = true; }
void listSelfCollision(FeatureScene& scene) { scene.scene.effects.self_collision = true; }
void listAir(FeatureScene& scene) { scene.scene.effects.air = cloth::Air(); }
void listWind(FeatureScene& scene) {
  listAir(scene);
  scene.scene.effects.air->wind = {{2.0, 0.0, 0.0}, {{{0.8, 0.0, 0.0}, 0.3, 0.0}}};
}
void listObstacles(FeatureScene& scene) { scene.scene.effects.contacts = true; }
void listFingers(FeatureScene& scene) {
  scene.scene.fingers = scene.scene.effects.point_loads = true;
}

/// As two fingertips leave them, spread over the middle of the sheet.
void listTouchingFingers(FeatureScene& scene) {
  listFingers(scene);
  const mesh::ClothMesh& mesh = scene.scene.mesh;
  const std::size_t middle = mesh.triangles.size() / 2;
  for (int i = 0; i < kTouched; ++i) {
    const std::size_t triangle = (middle + i / 8) % mesh.triangles.size();
    const Vector3d weights(0.5, 0.25, 0.25);
    Vector3d place = Vector3d::Zero();
    for (int corner = 0; corner < 3; ++corner) {
      place += weights[corner] * mesh.initial_positions[mesh.triangles[triangle][corner]];
    }
    scene.loads.push_back({static_cast<int>(triangle), weights, place, Vector3d(1e-3, 0.0, 0.0),
                           5.0 * Eigen::Matrix3d::Identity()});
  }
}

}  // namespace

simulation::SteppedScene FeatureScene::stepped() const {
  simulation::SteppedScene stepped(scene, std::vector<material::Fabric>(1, fabric));
  stepped.setPointLoads(loads);
  return stepped;
}

FeatureScene bareScene(const material::Fabric& fabric, int cells) {
  FeatureScene bare;
  bare.fabric.name = fabric.name;
  bare.fabric.areal_density = fabric.areal_density;
  bare.fabric.weft.elastic = fabric.weft.elastic;
  bare.fabric.warp.elastic = fabric.warp.elastic;
  bare.fabric.shear.elastic = fabric.shear.elastic;
  bare.scene.mesh =
      mesh::makeRectangle(kSize, kSize, cells, cells, mesh::Triangulation::kAlternating);
  bare.scene.attached_particles = mesh::sideParticles(bare.scene.mesh, mesh::Side::kTop);
  bare.scene.time_step = 0.0125;
  bare.scene.step.newton_iterations = 2;
  return bare;
}

const std::vector<Feature>& features() {
  static const std::vector<Feature> all = {
      {"gravity", describeNothing, listGravity},
      {"viscosity", describeViscosity, listViscosity},
      {"membrane_hysteresis", describeMembraneHysteresis, listMembraneHysteresis},
      {"bending_linear", describeBending, listBending},
      {"bending_quadratic", describeQuadraticBending, listBending},
      {"bending_hysteresis", describeHysteresis, listHysteresis},
      {"contraction", describeContraction, listContraction},
      {"self_collision_far", describeFingers, listSelfCollision},
      {"air", describeNothing, listAir},
      {"wind", describeNothing, listWind},
      {"obstacles_far", describeFarObstacle, listObstacles},
      {"obstacles_touching", describeTouchedObstacle, listObstacles},
      {"fingers_far", describeFingers, listFingers},
      {"fingers_touching", describeFingers, listTouchingFingers},
  };
  return all;
}

}  // namespace haptex::studies
