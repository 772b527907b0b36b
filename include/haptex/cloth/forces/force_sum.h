// All forces on a cloth as one.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "haptex/cloth/forces/force.h"
#include "haptex/cloth/forces/ties.h"

namespace haptex::cloth {

/// Adds up what its forces do, in their order. Their memories, and what they hold fixed, stand one
/// after the other. Where particles are tied, what forces do to them is done to the particles that
/// they are tied to: forces, Jacobians and systems are those of the free particles (Ties).
class ForceSum final : public Force {
 public:
  ForceSum() = default;
  ForceSum(ForceSum&&) = default;
  ForceSum& operator=(ForceSum&&) = default;

  /// @param force not null. @returns the same
  template <typename AForce>
  AForce& add(std::unique_ptr<AForce> force) {
    AForce& added = *force;
    forces_.push_back(std::move(force));
    return added;
  }

  /// @param ties not empty; has to outlive this and to be bound to the same matrix
  void setTies(const Ties& ties) { ties_ = &ties; }

  /// Takes all forces of another sum.
  void addAll(ForceSum&& other);

  /// The first force of a kind; null if there is none.
  template <typename AForce>
  const AForce* find() const {
    for (const auto& force : forces_) {
      if (const auto* found = dynamic_cast<const AForce*>(force.get())) return found;
    }
    return nullptr;
  }
  template <typename AForce>
  AForce* find() {
    return const_cast<AForce*>(std::as_const(*this).find<AForce>());
  }

  /// All forces of a kind, in their order.
  template <typename AForce>
  std::vector<const AForce*> findAll() const {
    std::vector<const AForce*> found;
    for (const auto& force : forces_) {
      if (const auto* one = dynamic_cast<const AForce*>(force.get())) found.push_back(one);
    }
    return found;
  }

  std::vector<std::array<int, 2>> pairs() const override;
  void bind(const linear::SymmetricBlockMatrix& matrix) override;
  std::size_t memorySize() const override;
  std::vector<std::vector<int>> memoryOwners() const override;
  void forget(const Positions& positions, double* memory) const override;
  void remember(const Positions& positions, double* memory) const override;
  void addForces(const ForceState& state, std::vector<Eigen::Vector3d>& forces) const override;
  /// The same, with what acts on tied particles left there.
  void addUntiedForces(const ForceState& state, std::vector<Eigen::Vector3d>& forces) const;
  /// Adds the forces (N) of those that are driven.
  void addDrivenForces(const ForceState& state, std::vector<Eigen::Vector3d>& forces) const;
  double energy(const ForceState& state) const override;
  void addJacobian(const ForceState& state, JacobianRows& rows) const override;
  bool isDriven() const override;
  bool changesWithTime() const override;
  double drivingPower(const ForceState& state) const override;
  void assembleLinearised(const ForceState& state, const StageTimes& times,
                          linear::SymmetricBlockMatrix& matrix,
                          linear::BlockVector& rhs) const override;
  std::size_t heldSize() const override;
  void hold(const NewtonStart& start, Eigen::Vector3d* held) const override;
  void assembleNewton(const ForceState& state, const Eigen::Vector3d* held, double a,
                      Hessian hessian, linear::SymmetricBlockMatrix& matrix,
                      linear::BlockVector& rhs) const override;
  double incrementalPotential(const ForceState& state, const Eigen::Vector3d* held,
                              double a) const override;

 private:
  template <typename Call>
  void forEach(const ForceState& state, Call&& call) const;

  std::vector<std::unique_ptr<Force>> forces_;
  const Ties* ties_ = nullptr;  // null: nothing is tied
};

}  // namespace haptex::cloth
