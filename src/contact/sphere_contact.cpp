#include "haptex/contact/sphere_contact.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptex::contact {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kNoDirection = 1e-9;  // m from the centre: no normal can be told

}  // namespace

void addFriction(const Vector3d& offset, double sticking, double coefficient,
                 TouchedParticle& contact) {
  const Matrix3d across = Matrix3d::Identity() - contact.normal * contact.normal.transpose();
  const Vector3d anchored = across * offset;
  const double limit = coefficient * contact.normal_force;
  const double pull = sticking * anchored.norm();
  contact.slips = pull > limit;
  const double held = contact.slips ? sticking * limit / pull : sticking;
  contact.friction = -held * anchored;
  contact.tangent = contact.stiffness + held * across;
  contact.stiffness = contact.tangent;
  if (contact.slips) {
    const Vector3d direction = anchored.normalized();
    contact.tangent -= held * direction * direction.transpose();
  }
}

SphereContact::SphereContact(const ContactLaw& law, std::size_t most_particles)
    : laws_(&law), anchors_(most_particles) {
  touched_.reserve(most_particles);
}

SphereContact::SphereContact(const std::vector<ContactLaw>& laws, std::vector<std::uint8_t> fabrics,
                             std::size_t most_particles)
    : laws_(laws.data()), fabrics_(std::move(fabrics)), anchors_(most_particles) {
  touched_.reserve(most_particles);
}

void SphereContact::clear() {
  for (Anchor& anchor : anchors_) anchor.holds = false;
  touched_.clear();
}

void SphereContact::adoptAnchor(int particle, const SphereContact& other, int other_particle) {
  anchors_[particle] = other.anchors_[other_particle];
}

bool SphereContact::touch(int i, const Particles& particles, const Fingertip& fingertip,
                          TouchedParticle& result) const {
  const ContactLaw& law = lawOf(i);
  const double layers = particles.layers_before ? (*particles.layers_before)[i] : 0.0;
  const double reach = fingertip.radius + law.reachThrough(std::ceil(layers));
  const Vector3d offset = particles.positions[i] - fingertip.position;
  const double squared_distance = offset.squaredNorm();
  if (!(squared_distance < reach * reach)) return false;
  const double distance = std::sqrt(squared_distance);
  if (distance < kNoDirection) return false;
  const Vector3d normal = offset / distance;
  const double area = particles.areas[i];
  const material::CurveValue pressure =
      layers > 0.0 ? law.pressureThrough(layers, distance - fingertip.radius)
                   : law.pressure(reach - distance);
  const Vector3d sliding =
      particles.velocities[i] - fingertip.velocity - fingertip.angular_velocity.cross(offset);
  // Hunt and Crossley 1975: damping in proportion to the elastic force, so it starts from zero.
  const double damping = area * pressure.stress * law.damping();
  const double approach = -normal.dot(sliding);
  result.particle = i;
  result.normal = normal;
  result.depth = reach - distance;
  result.normal_force = std::max(0.0, area * pressure.stress + damping * approach);
  const Matrix3d along = normal * normal.transpose();
  const bool pushes = result.normal_force > 0.0;
  result.stiffness = (pushes ? area * pressure.slope : 0.0) * along;
  result.damping = (pushes ? damping : 0.0) * along;

  const Anchor& anchor = anchors_[i];
  const Vector3d anchored = anchor.holds ? Vector3d(offset - fingertip.orientation * anchor.place)
                                         : Vector3d(Vector3d::Zero());
  addFriction(anchored, law.tangentialStiffness() * area, law.friction(), result);
  return true;
}

const std::vector<TouchedParticle>& SphereContact::evaluate(const Particles& particles,
                                                            const Fingertip& fingertip) {
  touched_.clear();
  TouchedParticle touched;
  for (int i = 0; i < particles.count; ++i) {
    if (touch(i, particles, fingertip, touched)) touched_.push_back(touched);
  }
  return touched_;
}

const std::vector<TouchedParticle>& SphereContact::commit(const Particles& particles,
                                                          const Fingertip& fingertip) {
  evaluate(particles, fingertip);
  auto next = touched_.begin();
  for (int i = 0; i < particles.count; ++i) {
    Anchor& anchor = anchors_[i];
    if (next == touched_.end() || next->particle != i) {
      anchor.holds = false;
      continue;
    }
    if (!anchor.holds || next->slips) {
      // The spring that is left after the slip pulls with exactly the friction.
      const double sticking = lawOf(i).tangentialStiffness() * particles.areas[i];
      const Vector3d place = particles.positions[i] + next->friction / sticking;
      anchor.place = fingertip.orientation.conjugate() * (place - fingertip.position);
      anchor.holds = true;
    }
    ++next;
  }
  return touched_;
}

}  // namespace haptex::contact
