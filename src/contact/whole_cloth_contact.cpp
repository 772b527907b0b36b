#include "haptex/contact/whole_cloth_contact.h"

#include <cmath>

namespace haptex::contact {

using base::Finger;
using base::kFingers;
using Eigen::Matrix3d;
using Eigen::Vector3d;

WholeClothContact::WholeClothContact(const mesh::ClothMesh& mesh, const material::Fabric& fabric,
                                     const ContactLaw& law)
    : rest_coordinates_(mesh.rest_coordinates),
      areas_(mesh.rest_coordinates.size(), 0.0),
      areal_density_(fabric.areal_density),
      triangle_of_(mesh.rest_coordinates.size(), 0),
      corner_of_(mesh.rest_coordinates.size(), 0),
      positions_(mesh.rest_coordinates.size(), Vector3d::Zero()),
      velocities_(positions_),
      contacts_{{SphereContact(law, mesh.rest_coordinates.size()),
                 SphereContact(law, mesh.rest_coordinates.size())}} {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::array<int, 3>& triangle = mesh.triangles[t];
    const Eigen::Vector2d a = rest_coordinates_[triangle[1]] - rest_coordinates_[triangle[0]];
    const Eigen::Vector2d b = rest_coordinates_[triangle[2]] - rest_coordinates_[triangle[0]];
    for (int corner = 0; corner < 3; ++corner) {
      areas_[triangle[corner]] += std::abs(a.x() * b.y() - a.y() * b.x()) / 6.0;
      triangle_of_[triangle[corner]] = static_cast<int>(t);
      corner_of_[triangle[corner]] = corner;
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
    const double inertia = areal_density_ * areas_[touched.particle] / (h * h);
    // k - k (k + m/h^2)^-1 k = m/h^2 (k + m/h^2)^-1 k
    Matrix3d both = touched.tangent;
    both.diagonal().array() += inertia;
    sum += inertia * both.inverse() * touched.tangent;
  }
  return 0.5 * (sum + sum.transpose());
}

}  // namespace haptex::contact
