// Contact with the particles of the large-scale cloth itself, where that is stepped at a high rate.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/contact/fingertip.h"
#include "haptex/contact/sphere_contact.h"

namespace haptex::contact {

/// The particles of a large-scale state, moved on by their velocities until now.
class WholeClothContact {
 public:
  /// @param fabrics of the cloth @param laws of each; kept
  WholeClothContact(const mesh::ClothMesh& mesh, const std::vector<material::Fabric>& fabrics,
                    const std::vector<ContactLaw>& laws);

  /// Sizes are those of the mesh.
  /// @param period s, from the state's time to that of the step that it is used in
  void receive(const std::vector<Eigen::Vector3d>& positions,
               const std::vector<Eigen::Vector3d>& velocities, double period);
  void step(const base::PerFinger<const Fingertip*>& fingertips);

  const SphereContact& contact(base::Finger finger) const { return contacts_[finger]; }
  Particles particles() const;
  /// -d force / d position of the fingertip within a step of h (N/m): contact springs in series
  /// with the inertia of their particles.
  Eigen::Matrix3d stiffness(base::Finger finger, double h) const;
  /// m, along weft and warp, in the panel of triangleOf().
  const Eigen::Vector2d& restCoordinates(int particle) const { return rest_coordinates_[particle]; }
  /// A triangle with the particle as its corner.
  int triangleOf(int particle) const { return triangle_of_[particle]; }
  int cornerOf(int particle) const { return corner_of_[particle]; }
  /// Which of the cloth's fabrics a particle is of: on the border of two that of the first triangle
  /// around it.
  int fabricOf(int particle) const { return fabrics_.empty() ? 0 : fabrics_[particle]; }

 private:
  std::vector<Eigen::Vector2d> rest_coordinates_;
  std::vector<double> areas_;   // m^2
  std::vector<double> masses_;  // kg
  std::vector<int> triangle_of_;
  std::vector<int> corner_of_;
  std::vector<std::uint8_t> fabrics_;  // empty: all are of the first
  std::vector<Eigen::Vector3d> positions_;
  std::vector<Eigen::Vector3d> velocities_;
  base::PerFinger<SphereContact> contacts_;
};

}  // namespace haptex::contact
