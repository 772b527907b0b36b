#include "haptex/contact/whole_cloth_contact.h"

#include <cmath>

namespace haptex::contact {

using base::Finger;
using base::kFingers;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// Of the first triangle around each particle; empty for one fabric.
std::vector<std::uint8_t> fabricsOf(const mesh::ClothMesh& mesh) {
  if (mesh.triangle_fabrics.empty()) return {};
  std::vector<std::uint8_t> fabrics(mesh.rest_coordinates.size(), 0);
  for (std::size_t t = mesh.triangles.size(); t-- > 0;) {
    for (const int particle : mesh.triangles[t]) {
      fabrics[particle] = static_cast<std::uint8_t>(mesh.triangle_fabrics[t]);
    }
  }
  return fabrics;
}

}  // namespace

WholeClothContact::WholeClothContact(const mesh::ClothMesh& mesh,
                                     const std::vector<material::Fabric>& fabrics,
                                     const std::vector<ContactLaw>& laws)
    : rest_coordinates_(mesh.rest_coordinates),
      areas_(mesh.rest_coordinates.size(), 0.0),
      masses_(mesh.rest_coordinates.size(), 0.0),
      triangle_of_(mesh.rest_coordinates.size(), 0),
      corner_of_(mesh.rest_coordinates.size(), 0),
      fabrics_(fabricsOf(mesh)),
      positions_(mesh.rest_coordinates.size(), Vector3d::Zero()),
      velocities_(positions_),
      contacts_{{SphereContact(laws, fabrics_, mesh.rest_coordinates.size()),
                 SphereContact(laws, fabrics_, mesh.rest_coordinates.size())}} {
  std::vector<std::vector<double>> areas_of_fabrics(fabrics.size(), areas_);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::array<int, 3>& triangle = mesh.triangles[t];
    const std::array<Eigen::Vector2d, 3> rest = mesh.restCorners(t);
    const Eigen::Vector2d a = rest[1] - rest[0];
    const Eigen::Vector2d b = rest[2] - rest[0];
    for (int corner = 0; corner < 3; ++corner) {
      const double area = std::abs(a.x() * b.y() - a.y() * b.x()) / 6.0;
      areas_[triangle[corner]] += area;
      areas_of_fabrics[mesh.fabricOf(t)][triangle[corner]] += area;
      triangle_of_[triangle[corner]] = static_cast<int>(t);
      corner_of_[triangle[corner]] = corner;
      rest_coordinates_[triangle[corner]] = rest[corner];
    }
  }
  for (std::size_t f = 0; f < fabrics.size(); ++f) {
    for (std::size_t i = 0; i < masses_.size(); ++i) {
      masses_[i] += fabrics[f].areal_density * areas_of_fabrics[f][i];
    }
  }
}

void WholeClothContact::receive(const std::vector<Vector3d>& positions,
                                const std::vector<Vector3d>& velocities, double period) {
  for (std::size_t i = 0; i < positions.size(); ++i) {
    positions_[i] = positions[i] + period * velocities[i];
    velocities_[i] = velocities[i];
  }
}

Particles WholeClothContact::particles() const {
  return {positions_, velocities_, areas_, static_cast<int>(positions_.size())};
}

void WholeClothContact::step(const base::PerFinger<const Fingertip*>& fingertips) {
  for (const Finger finger : kFingers) {
    if (fingertips[finger]) {
      contacts_[finger].commit(particles(), *fingertips[finger]);
    } else {
      contacts_[finger].clear();
    }
  }
}

Matrix3d WholeClothContact::stiffness(Finger finger, double h) const {
  Matrix3d sum = Matrix3d::Zero();
  for (const TouchedParticle& touched : contacts_[finger].touched()) {
    const double inertia = masses_[touched.particle] / (h * h);
    // k - k (k + m/h^2)^-1 k = m/h^2 (k + m/h^2)^-1 k
    Matrix3d both = touched.tangent;
    both.diagonal().array() += inertia;
    sum += inertia * both.inverse() * touched.tangent;
  }
  return 0.5 * (sum + sum.transpose());
}

}  // namespace haptex::contact
