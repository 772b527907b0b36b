#include "haptex/kes/virtual_test.h"

#include <cmath>
#include <random>

#include "haptex/base/require.h"
#include "haptex/base/workload.h"
#include "haptex/material/strain_measures.h"

namespace haptex::kes {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// 2500 elements, longer across the jaws than along, like the sample.
constexpr int kCellsAlongJaw = base::unlessSanitized(50, 12);
constexpr int kCellsBetweenJaws = base::unlessSanitized(25, 6);

/// Regular for springs, which need that.
mesh::ClothMesh sampleMesh(bool weft, unsigned seed,
                           cloth::Elasticity elasticity = cloth::Elasticity::kGreenLagrange) {
  const double width = weft ? kSampleLength : kSampleWidth;
  const double height = weft ? kSampleWidth : kSampleLength;
  const int cells_u = weft ? kCellsBetweenJaws : kCellsAlongJaw;
  const int cells_v = weft ? kCellsAlongJaw : kCellsBetweenJaws;
  if (elasticity == cloth::Elasticity::kMassSpring) {
    return mesh::makeRectangle(width, height, cells_u, cells_v, mesh::Triangulation::kAlternating);
  }
  return irregularRectangle(width, height, cells_u, cells_v, seed);
}

cloth::ModelledEffects effectsOf(cloth::Elasticity elasticity) {
  cloth::ModelledEffects effects;
  effects.elasticity = elasticity;
  return effects;
}

/// Takes half of the shifts of triangles that they turn over, or nearly so, until none is: one in
/// some ten thousand. @param cell m^2
void keepUpright(const mesh::ClothMesh& regular, double cell, std::vector<Vector2d>& shifts) {
  constexpr double kLeast = 0.02;  // of what it was
  for (bool sound = false; !sound;) {
    sound = true;
    for (const auto& [a, b, c] : regular.triangles) {
      const auto place = [&](int i) { return Vector2d(regular.rest_coordinates[i] + shifts[i]); };
      const Vector2d ab = place(b) - place(a), ac = place(c) - place(a);
      if (ab.x() * ac.y() - ab.y() * ac.x() >= kLeast * cell) continue;
      sound = false;
      for (const int particle : {a, b, c}) shifts[particle] *= 0.5;
    }
  }
}

}  // namespace

mesh::ClothMesh irregularRectangle(double width, double height, int cells_u, int cells_v,
                                   unsigned seed) {
  mesh::ClothMesh mesh =
      mesh::makeRectangle(width, height, cells_u, cells_v, mesh::Triangulation::kAlternating);
  std::vector<Vector2d> shifts(mesh.rest_coordinates.size(), Vector2d::Zero());
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> part(-0.3, 0.3);
  for (int j = 1; j < cells_v; ++j) {
    for (int i = 1; i < cells_u; ++i) {
      const double along_v = part(random) * height / cells_v;
      const double along_u = part(random) * width / cells_u;
      shifts[j * (cells_u + 1) + i] = {along_u, along_v};
    }
  }
  keepUpright(mesh, width / cells_u * (height / cells_v), shifts);
  for (std::size_t i = 0; i < shifts.size(); ++i) {
    mesh.rest_coordinates[i] += shifts[i];
    mesh.initial_positions[i] += Vector3d(0.0, shifts[i].x(), shifts[i].y());
  }
  return mesh;
}

TensileRig::TensileRig(const material::Fabric& fabric, Direction direction,
                       const cloth::ModelledEffects& effects)
    : weft_(direction == Direction::kWeft),
      sample_(sampleMesh(weft_, 2, effects.elasticity), fabric, effects) {
  jaw_ = sideParticles(sample_.mesh(), weft_ ? mesh::Side::kRight : mesh::Side::kTop);
  held_ = sideParticles(sample_.mesh(), weft_ ? mesh::Side::kLeft : mesh::Side::kBottom);
  held_.insert(held_.end(), jaw_.begin(), jaw_.end());
}

void TensileRig::pull(double strain) {
  const double stretch = 1.0 + strain;
  sample_.equilibrate(held_, [&](const Vector2d& rest) {
    return weft_ ? Vector3d(0.0, stretch * rest.x(), rest.y())
                 : Vector3d(0.0, rest.x(), stretch * rest.y());
  });
}

void TensileRig::move(double strain_rate) {
  sample_.moveAs([&](const Vector2d& rest) {
    return weft_ ? Vector3d(0.0, strain_rate * rest.x(), 0.0)
                 : Vector3d(0.0, 0.0, strain_rate * rest.y());
  });
}

double TensileRig::force() const {
  double force = 0.0;
  for (int particle : jaw_) force += sample_.reaction(particle)[weft_ ? 1 : 2];
  return force;
}

ShearRig::ShearRig(const material::Fabric& fabric, Direction direction,
                   const cloth::ModelledEffects& effects)
    : weft_(direction == Direction::kWeft), sample_(sampleMesh(!weft_, 3), fabric, effects) {
  jaw_ = sideParticles(sample_.mesh(), weft_ ? mesh::Side::kTop : mesh::Side::kRight);
  for (mesh::Side side :
       {mesh::Side::kTop, mesh::Side::kBottom, mesh::Side::kLeft, mesh::Side::kRight}) {
    const std::vector<int> particles = sideParticles(sample_.mesh(), side);
    held_.insert(held_.end(), particles.begin(), particles.end());
  }
}

void ShearRig::shear(double shear, double height, const Vector3d& disturbance) {
  const auto place = [&](const Vector2d& rest) {
    return weft_ ? Vector3d(0.0, rest.x() + shear * rest.y(), height * rest.y())
                 : Vector3d(0.0, height * rest.x(), rest.y() + shear * rest.x());
  };
  sample_.equilibrate(held_, place, disturbance);
}

void ShearRig::move(double shear_rate, double height_rate) {
  sample_.moveAs([&](const Vector2d& rest) {
    return weft_ ? Vector3d(0.0, shear_rate * rest.y(), height_rate * rest.y())
                 : Vector3d(0.0, height_rate * rest.x(), shear_rate * rest.x());
  });
}

ShearRig::Force ShearRig::force() const {
  // The corners also carry the guides of the sides: the force on the whole jaw follows from the
  // particles between them, which hold all of it but half a cell at either end.
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 1; i + 1 < jaw_.size(); ++i) sum += sample_.reaction(jaw_[i]);
  sum *= kCellsAlongJaw / (kCellsAlongJaw - 1.0);
  return weft_ ? Force{sum.y(), sum.z()} : Force{sum.z(), sum.y()};
}

std::vector<Reading> tensileTest(const material::Fabric& fabric, Direction direction,
                                 const std::vector<double>& strains, cloth::Elasticity elasticity) {
  TensileRig rig(fabric, direction, effectsOf(elasticity));
  std::vector<Reading> readings;
  for (double strain : strains) {
    rig.pull(strain);
    readings.push_back({strain, rig.force()});
  }
  return readings;
}

std::vector<Reading> shearTest(const material::Fabric& fabric, const std::vector<double>& shears) {
  ShearRig rig(fabric, Direction::kWeft);
  std::vector<Reading> readings;
  for (double shear : shears) {
    rig.shear(shear, 1.0);
    readings.push_back({shear, rig.force().along});
  }
  return readings;
}

double exactTensileForce(const material::Fabric& fabric, Direction direction, double strain) {
  base::require(std::isfinite(strain) && strain > -1.0, "exactTensileForce", "strain", strain,
                "finite and > -1");
  const material::MembraneCurves& curves =
      direction == Direction::kWeft ? fabric.weft : fabric.warp;
  // With the stretch itself: near collapse it is lost in the rounding of Green's strain.
  return kSampleWidth * (1.0 + strain) *
         curves.elastic.evaluate(material::greenStrain(strain)).stress;
}

double exactShearForce(const material::Fabric& fabric, double shear) {
  base::require(std::isfinite(shear), "exactShearForce", "shear", shear, "finite");
  return kSampleWidth * (fabric.shear.elastic.evaluate(shear).stress +
                         shear * fabric.warp.elastic.evaluate(0.5 * shear * shear).stress);
}

}  // namespace haptex::kes
