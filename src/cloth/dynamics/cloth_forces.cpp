// The forces of a cloth, their energy and their Jacobian: the sums over everything that is
// modelled.
#include <map>

#include "haptex/cloth/dynamics/cloth.h"

namespace haptex::cloth {

using Eigen::Vector3d;

/// Calls with what resists stretch and shear: Membrane, SpringLattice or Corotational.
template <typename Call>
auto Cloth::withElasticity(Call&& call) const {
  if (springs_) return call(*springs_);
  if (corotational_) return call(*corotational_);
  return call(membrane_);
}

void Cloth::computeForces(const ClothState& state, std::vector<Eigen::Vector3d>& forces) const {
  requireState(state);
  forces.resize(particleCount());
  for (std::size_t i = 0; i < particleCount(); ++i) {
    forces[i] = external_forces_[i] + masses_[i] * effects_.gravity;
  }
  withElasticity(
      [&](const auto& elastic) { elastic.addForces(state.positions, state.velocities, forces); });
  if (bending_) bending_->addForces(state.positions, forces);
  if (bendingFriction()) bendingFriction()->addForces(state.positions, state.plastic_bends, forces);
  if (air_) {
    air_->addForces(membrane_.elements(), state.positions, state.velocities, state.time, forces);
  }
  addPointForces(point_loads_, mesh_.triangles, state.positions, forces);
}

double Cloth::potentialEnergy(const ClothState& state) const {
  requireState(state);
  double energy =
      withElasticity([&](const auto& elastic) { return elastic.elasticEnergy(state.positions); });
  energy += pointLoadEnergy(point_loads_, mesh_.triangles, state.positions);
  if (bending_) energy += bending_->energy(state.positions);
  if (bendingFriction()) energy += bendingFriction()->energy(state.positions, state.plastic_bends);
  for (std::size_t i = 0; i < particleCount(); ++i) {
    energy -= (external_forces_[i] + masses_[i] * effects_.gravity).dot(state.positions[i]);
  }
  return energy;
}

double Cloth::kineticEnergy(const ClothState& state) const {
  requireState(state);
  double energy = 0.0;
  for (std::size_t i = 0; i < particleCount(); ++i) {
    energy += 0.5 * masses_[i] * state.velocities[i].squaredNorm();
  }
  return energy;
}

double Cloth::windPower(const ClothState& state) const {
  requireState(state);
  if (!air_) return 0.0;
  return air_->windPower(membrane_.elements(), state.positions, state.velocities, state.time);
}

void Cloth::fixAir(const Positions& positions, const Velocities& velocities, double time,
                   FixedAir& fixed) const {
  if (air_) air_->fix(membrane_.elements(), positions, velocities, time, fixed);
}

void Cloth::addStep(const Positions& positions, const Velocities& velocities,
                    const PlasticBends& plastic, const StageTimes& times,
                    linear::SymmetricBlockMatrix& matrix, linear::BlockVector& rhs) const {
  addConstantForces(times.a, rhs);
  withElasticity(
      [&](const auto& elastic) { elastic.addStep(positions, velocities, times, matrix, rhs); });
  if (air_) air_->addStep(membrane_.elements(), positions, velocities, times, matrix, rhs);
  if (bendingFriction())
    bendingFriction()->addStep(positions, velocities, plastic, times, matrix, rhs);
  addLinearForces(positions, velocities, times, matrix, rhs);
}

std::size_t Cloth::strainCount() const {
  return withElasticity([](const auto& elastic) { return elastic.strainCount(); });
}

void Cloth::computeStrains(const Positions& positions, std::vector<MembraneStrain>& strains) const {
  withElasticity([&](const auto& elastic) { elastic.computeStrains(positions, strains); });
}

void Cloth::computeStrainsBefore(const Positions& positions, const Velocities& velocities,
                                 double interval, std::vector<MembraneStrain>& strains) const {
  withElasticity([&](const auto& elastic) {
    elastic.computeStrainsBefore(positions, velocities, interval, strains);
  });
}

void Cloth::addNewton(const Positions& positions, const Velocities& velocities,
                      const PlasticBends& plastic, const std::vector<MembraneStrain>& begin_strains,
                      const FixedAir& fixed_air, double a, Membrane::Hessian hessian,
                      linear::SymmetricBlockMatrix& matrix, linear::BlockVector& rhs) const {
  addConstantForces(a, rhs);
  withElasticity([&](const auto& elastic) {
    elastic.addNewton(positions, begin_strains, a, hessian, matrix, rhs);
  });
  if (air_) air_->addNewton(membrane_.elements(), velocities, fixed_air, a, matrix, rhs);
  if (bendingFriction()) bendingFriction()->addNewton(positions, plastic, a, hessian, matrix, rhs);
  addLinearForces(positions, velocities, {a, 0.0}, matrix, rhs);
}

void Cloth::addConstantForces(double a, linear::BlockVector& rhs) const {
  for (std::size_t i = 0; i < particleCount(); ++i) {
    rhs.col(i) += a * (external_forces_[i] + masses_[i] * effects_.gravity);
  }
}

/// Those whose Jacobian does not depend on the positions.
void Cloth::addLinearForces(const Positions& positions, const Velocities& velocities,
                            const StageTimes& times, linear::SymmetricBlockMatrix& matrix,
                            linear::BlockVector& rhs) const {
  if (bending_) bending_->addStep(positions, velocities, times, matrix, rhs);
  addPointLoadStep(point_loads_, mesh_.triangles, membrane_.elements(), positions, velocities,
                   times, matrix, rhs);
}

double Cloth::incrementalPotential(const Positions& positions, const Velocities& velocities,
                                   const PlasticBends& plastic,
                                   const std::vector<MembraneStrain>& begin_strains,
                                   const FixedAir& fixed_air, double a) const {
  double potential = withElasticity([&](const auto& elastic) {
    return elastic.incrementalPotential(positions, begin_strains, a);
  });
  potential += pointLoadEnergy(point_loads_, mesh_.triangles, positions);
  if (bending_) potential += bending_->energy(positions);
  if (bendingFriction()) potential += bendingFriction()->energy(positions, plastic);
  if (air_) potential += air_->incrementalPotential(membrane_.elements(), velocities, fixed_air, a);
  return potential;
}

void Cloth::addPointLoadJacobian(const std::map<int, std::vector<std::size_t>>& rows_of_particle,
                                 std::vector<JacobianRow>& rows) const {
  for (const PointLoad& load : point_loads_) {
    const std::array<int, 3>& corners = mesh_.triangles[load.triangle];
    for (int i = 0; i < 3; ++i) {
      const auto asked = rows_of_particle.find(corners[i]);
      if (asked == rows_of_particle.end()) continue;
      for (std::size_t r : asked->second) {
        for (int j = 0; j < 3; ++j) {  // the elasticity has made the block
          rows[r].at(corners[j]).by_position -= load.weights[i] * load.weights[j] * load.stiffness;
        }
      }
    }
  }
}

/// Of one element, whose blocks the elasticity has made.
void Cloth::addAirJacobian(const ClothState& state, std::size_t element,
                           const std::map<int, std::vector<std::size_t>>& rows_of_particle,
                           std::vector<JacobianRow>& rows) const {
  const MembraneElement& at = membrane_.elements()[element];
  const Aerodynamics::Jacobian jacobian =
      air_->exactJacobian(at, state.positions, state.velocities, state.time);
  for (int particle : at.particles) {
    const auto asked = rows_of_particle.find(particle);
    if (asked == rows_of_particle.end()) continue;
    for (std::size_t r : asked->second) {
      for (int j = 0; j < 3; ++j) {
        JacobianBlock& block = rows[r].at(at.particles[j]);
        block.by_position += jacobian.by_position[j];
        block.by_velocity += jacobian.by_velocity;
      }
    }
  }
}

void Cloth::addBendingJacobian(const ClothState& state,
                               const std::map<int, std::vector<std::size_t>>& rows_of_particle,
                               std::vector<JacobianRow>& rows) const {
  const auto add = [&](int row, int column, const Eigen::Matrix3d& block) {
    const auto asked = rows_of_particle.find(row);
    if (asked == rows_of_particle.end()) return;
    for (std::size_t r : asked->second) {
      const JacobianBlock empty{row, column, Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero()};
      rows[r].emplace(column, empty).first->second.by_position += block;
    }
  };
  for (const Bending::Coupling& coupling : bending_->couplings()) {
    const Eigen::Matrix3d block = coupling.stiffness * Eigen::Matrix3d::Identity();
    for (const auto& [row, column] :
         {std::pair(coupling.row, coupling.column), std::pair(coupling.column, coupling.row)}) {
      add(row, row, block);
      add(row, column, -block);
    }
  }
  if (bending_->restCurvature()) bending_->restCurvature()->jacobian(state.positions, add);
  if (bendingFriction()) bendingFriction()->jacobian(state.positions, state.plastic_bends, add);
}

template <typename Element>
void Cloth::addElementJacobian(const Element& forces, const ClothState& state,
                               const std::map<int, std::vector<std::size_t>>& rows_of_particle,
                               std::vector<JacobianRow>& rows) const {
  for (const MembraneElement& element : membrane_.elements()) {
    for (int i = 0; i < 3; ++i) {
      const auto asked = rows_of_particle.find(element.particles[i]);
      if (asked == rows_of_particle.end()) continue;
      const Membrane::Jacobian jacobian =
          forces.exactJacobian(element, state.positions, state.velocities);
      for (std::size_t r : asked->second) {
        for (int j = 0; j < 3; ++j) {
          JacobianBlock empty{element.particles[i], element.particles[j], Eigen::Matrix3d::Zero(),
                              Eigen::Matrix3d::Zero()};
          JacobianBlock& block = rows[r].emplace(element.particles[j], empty).first->second;
          block.by_position += jacobian.by_position[i][j];
          block.by_velocity += jacobian.by_velocity[i][j];
        }
      }
    }
  }
}

void Cloth::addSpringJacobian(const ClothState& state,
                              const std::map<int, std::vector<std::size_t>>& rows_of_particle,
                              std::vector<JacobianRow>& rows) const {
  for (const LatticeSpring& spring : springs_->springs()) {
    const std::array<int, 2> ends = {spring.first, spring.second};
    for (int row : ends) {
      const auto asked = rows_of_particle.find(row);
      if (asked == rows_of_particle.end()) continue;
      const auto [by_position, by_velocity] =
          springs_->exactJacobian(spring, state.positions, state.velocities);
      for (std::size_t r : asked->second) {
        for (int column : ends) {
          const double sign = column == row ? 1.0 : -1.0;
          JacobianBlock empty{row, column, Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero()};
          JacobianBlock& block = rows[r].emplace(column, empty).first->second;
          block.by_position += sign * by_position;
          block.by_velocity += sign * by_velocity;
        }
      }
    }
  }
}

std::vector<JacobianBlock> Cloth::jacobian(const ClothState& state,
                                           const std::vector<int>& particles) const {
  requireState(state);
  std::vector<JacobianRow> rows(particles.size());
  std::map<int, std::vector<std::size_t>> rows_of_particle;
  for (std::size_t r = 0; r < particles.size(); ++r) {
    requireParticle(particles[r]);
    rows_of_particle[particles[r]].push_back(r);
  }
  if (springs_) {
    addSpringJacobian(state, rows_of_particle, rows);
  } else if (corotational_) {
    addElementJacobian(*corotational_, state, rows_of_particle, rows);
  } else {
    addElementJacobian(membrane_, state, rows_of_particle, rows);
  }
  for (std::size_t t = 0; air_ && t < membrane_.elements().size(); ++t) {
    addAirJacobian(state, t, rows_of_particle, rows);
  }
  if (bending_) addBendingJacobian(state, rows_of_particle, rows);
  addPointLoadJacobian(rows_of_particle, rows);
  std::vector<JacobianBlock> blocks;
  for (const auto& row : rows) {
    for (const auto& entry : row) blocks.push_back(entry.second);
  }
  return blocks;
}

}  // namespace haptex::cloth
