#include "haptex/exoskeleton/emulator/emulated_finger.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>

#include "haptex/exoskeleton/control/minimum_jerk.h"

namespace haptex::exoskeleton {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kMinSingularValue = 1e-5;  // m/rad of a motor, below it the thimble is stuck

}  // namespace

EmulatedFinger::EmulatedFinger(const std::string& urdf, Finger finger,
                               const FingerMechanics& mechanics)
    : mechanics_(mechanics),
      linkage_(urdf, finger),
      kinematics_(urdf, finger),
      reach_(urdf, finger) {
  const JointVector zero = kinematics_.jointAngles(MotorVector::Zero());
  for (int i = 0; i < kMotors; ++i) {
    coupling_.col(i) = kinematics_.jointAngles(MotorVector::Unit(i)) - zero;
  }
  place(0.5 * (lowest() + highest()));
}

void EmulatedFinger::place(const MotorVector& motor_angles) {
  angles_ = motor_angles;
  velocities_.setZero();
  presliding_.setZero();
  linkage_.setAngles(kinematics_.jointAngles(angles_));
  fingertip_ = thimble().translation();
  fingertip_velocity_.setZero();
  target_ = {angles_, fingertip_};
  asked_target_ = reference_ = fingertip_;
  returned_ = 1.0;
  refresh();
}

void EmulatedFinger::setTarget(const Vector3d& target) {
  if (target == asked_target_) return;
  asked_target_ = target;
  target_ = reach_.nearest(target, target_.motor_angles);
}

void EmulatedFinger::relax(bool relaxed) {
  if (relaxed_ && !relaxed) {
    return_from_ = fingertip_;
    reference_ = target_.position;
    returned_ = 0.0;
  }
  relaxed_ = relaxed;
}

Vector3d EmulatedFinger::wantedPlace() const {
  if (returned_ >= 1.0) return reference_;
  return return_from_ + minimumJerk(returned_) * (reference_ - return_from_);
}

void EmulatedFinger::moveReference(double period) {
  const Vector3d way = target_.position - reference_;
  const double distance = way.norm(), possible = kTargetSpeed * period;
  reference_ = distance <= possible ? target_.position : reference_ + possible / distance * way;
  returned_ = std::min(1.0, returned_ + period / kReturn);
}

// A stop pushes only, and dampens only what moves into it.
MotorVector EmulatedFinger::stopTorques(MotorVector& damping) const {
  MotorVector torques = MotorVector::Zero();
  for (int i = 0; i < kMotors; ++i) {
    const double below = lowest()[i] - angles_[i], above = angles_[i] - highest()[i];
    const double into = below > 0.0 ? -velocities_[i] : velocities_[i];
    if (below <= 0.0 && above <= 0.0) continue;
    torques[i] = mechanics_.stop_stiffness * (below > 0.0 ? below : -above);
    if (into > 0.0) damping[i] += mechanics_.stop_damping;
  }
  return torques;
}

void EmulatedFinger::step(const MotorVector& torques, double period) {
  const FingerMechanics& m = mechanics_;
  moveReference(period);
  const double stiffness = relaxed_ ? 0.0 : m.fingertip_stiffness;
  const double fingertip_damping = relaxed_ ? m.relaxed_damping : m.fingertip_damping;
  const Vector3d held = stiffness * (wantedPlace() - fingertip_);

  MotorVector damping = MotorVector::Constant(m.viscous_friction);
  MotorVector sum = torques + stopTorques(damping);
  sum -= m.presliding_stiffness * presliding_;
  sum -= coupling_.transpose() * linkage_.biasTorques(coupling_ * velocities_, m.gravity);
  sum -= jacobian_.transpose() * contact_force_;

  const Matrix3d mass = massMatrix();
  Matrix3d damped_mass = mass;
  damped_mass.diagonal() += period * damping;
  velocities_ = damped_mass.inverse() * (mass * velocities_ + period * sum);
  angles_ += period * velocities_;
  // An elastic, perfectly plastic transmission: below Coulomb's friction it holds its place for
  // ever, where LuGre's bristles would creep (Dupont et al., Single state elastoplastic friction
  // models, 2002).
  const double give =
      m.presliding_stiffness > 0.0 ? m.coulomb_friction / m.presliding_stiffness : 0.0;
  presliding_ = (presliding_ + period * velocities_).cwiseMax(-give).cwiseMin(give);

  fingertip_velocity_ += period / m.fingertip_mass * (contact_force_ + held + push_);
  fingertip_velocity_ /= 1.0 + period * fingertip_damping / m.fingertip_mass;
  fingertip_ += period * fingertip_velocity_;
  refresh();
}

// What follows from the state.
void EmulatedFinger::refresh() {
  linkage_.setAngles(kinematics_.jointAngles(angles_));
  jacobian_ = linkage_.tipJacobian() * coupling_;
  contact_force_ = mechanics_.pulp_stiffness * (thimble().translation() - fingertip_) +
                   mechanics_.pulp_damping * (jacobian_ * velocities_ - fingertip_velocity_);
}

Matrix3d EmulatedFinger::massMatrix() const {
  Matrix3d mass = coupling_.transpose() * linkage_.massMatrix() * coupling_;
  mass.diagonal().array() += mechanics_.rotor_inertia;
  return mass;
}

Vector3d EmulatedFinger::forceOf(const MotorVector& torques) const {
  const Eigen::JacobiSVD<Matrix3d> svd(jacobian_, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vector3d force = Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    const double singular_value = svd.singularValues()[i];
    if (singular_value < kMinSingularValue) continue;
    force += svd.matrixU().col(i) * (svd.matrixV().col(i).dot(torques) / singular_value);
  }
  return force;
}

double EmulatedFinger::energy() const {
  const FingerMechanics& m = mechanics_;
  const double held = relaxed_ ? 0.0 : (wantedPlace() - fingertip_).squaredNorm();
  const MotorVector stops = (lowest() - angles_).cwiseMax(angles_ - highest()).cwiseMax(0.0);
  return linkage_.potentialEnergy(m.gravity) +
         0.5 *
             (velocities_.dot(massMatrix() * velocities_) +
              m.fingertip_mass * fingertip_velocity_.squaredNorm() + m.fingertip_stiffness * held +
              m.pulp_stiffness * (thimble().translation() - fingertip_).squaredNorm() +
              m.stop_stiffness * stops.squaredNorm() +
              m.presliding_stiffness * presliding_.squaredNorm());
}

}  // namespace haptex::exoskeleton
