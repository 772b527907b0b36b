#include "haptex/cloth/forces/self_contact/self_contact.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "haptex/base/quoted.h"

namespace haptex::cloth {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Friction by slip, as a share of that of what slips, and by what it is the integral of.
struct Smoothed {
  double potential;  // m
  double share;
  double slope;   // 1/m
  double secant;  // 1/m, share / slip
};

/// @param stick m, the slip from which on it is whole
Smoothed smoothed(double slip, double stick) {
  const double y = slip / stick;
  if (y >= 1.0) return {slip - stick / 3.0, 1.0, 0.0, 1.0 / slip};
  return {slip * y * (1.0 - y / 3.0), y * (2.0 - y), 2.0 * (1.0 - y) / stick, (2.0 - y) / stick};
}

template <typename Pair>
Vector3d weightedSum(const Pair& pair, const std::vector<Vector3d>& vectors) {
  Vector3d sum = Vector3d::Zero();
  for (int i = 0; i < pair.count; ++i) sum += pair.weights[i] * vectors[pair.vertices[i]];
  return sum;
}

Vector3d tangential(const Vector3d& vector, const Vector3d& normal) {
  return vector - normal.dot(vector) * normal;
}

/// Whether all particles of a pair are coupled in the matrix's fixed pattern.
template <typename Pair>
bool isInPattern(const Pair& pair, const linear::SymmetricBlockMatrix& matrix) {
  for (int i = 0; i < pair.count; ++i) {
    for (int j = 0; j < i; ++j) {
      if (pair.weights[i] * pair.weights[j] == 0.0) continue;
      if (!matrix.hasInPattern(pair.vertices[i], pair.vertices[j])) return false;
    }
  }
  return true;
}

/// Adds weights_i weights_j block. What couples both sides, whose weights differ in sign, is all in
/// the matrix's fixed pattern or all beyond it, so that of each pair the fixed part is positive
/// semidefinite, too, as factors need it: of cloth near its own neighbours it is a part of both.
template <typename Pair>
void addBlocks(const Pair& pair, const Matrix3d& block, linear::SymmetricBlockMatrix& matrix) {
  const bool in_pattern = isInPattern(pair, matrix);
  for (int i = 0; i < pair.count; ++i) {
    matrix.diagonal(pair.vertices[i]) += pair.weights[i] * pair.weights[i] * block;
    for (int j = 0; j < i; ++j) {
      const double weight = pair.weights[i] * pair.weights[j];
      if (weight > 0.0 || (in_pattern && weight != 0.0)) {
        matrix.addCoupling(pair.vertices[i], pair.vertices[j], weight * block);
      } else if (weight < 0.0) {
        matrix.addBeyondPattern(pair.vertices[i], pair.vertices[j], weight * block);
      }
    }
  }
}

}  // namespace

SelfContact::SelfContact(const RestSurface& rest, const std::vector<material::Fabric>& fabrics)
    : fabrics_(rest.fabrics),
      near_(rest, FabricLayers(fabrics).thickness()),
      energies_(rest, FabricLayers(fabrics)) {}

double SelfContact::margin() const {
  double most = 0.0;
  for (int f = 0; f < layers().count(); ++f) most = std::max(most, layers().law(f).margin());
  return most;
}

std::vector<double> SelfContact::particleMargins() const {
  if (fabrics_.empty()) return {};
  std::vector<double> margins(near_.particleCount(), margin());
  for (std::size_t t = 0; t < fabrics_.size(); ++t) {
    for (const int particle : near_.triangles()[t]) {
      margins[particle] = std::min(margins[particle], 0.5 * layers().law(fabrics_[t]).margin());
    }
  }
  return margins;
}

void SelfContact::setObstacles(std::shared_ptr<ObstacleSurfaces> surfaces) {
  obstacle_friction_.clear();
  touching_at_.clear();
  obstacles_.reset();
  if (!surfaces) return;
  for (int i = 0; i < surfaces->count(); ++i) {
    obstacle_friction_.push_back(surfaces->obstacle(i).friction);
  }
  energies_.setObstacles(*surfaces);
  obstacles_.emplace(near_.triangles(), near_.particleCount(), std::move(surfaces),
                     near_.searched());
}

bool SelfContact::leaveOut(const TangleSides& sides, const std::vector<TangleLink>& links) const {
  links_ = links;
  const bool changed = near_.leaveOut(sides);
  if (changed) touching_at_.clear();
  return changed;
}

const std::vector<PairEnergy>& SelfContact::touching(const Positions& positions, bool at_end,
                                                     linear::ThreadPool* pool) const {
  const int revision = obstacles_ ? obstacles_->surfaces().revision() : 0;
  at_end = at_end || !obstacles_ || !obstacles_->surfaces().moved();
  if (at_end == touching_at_end_ && revision == touching_revision_ && positions == touching_at_) {
    return touching_;
  }
  touching_at_end_ = at_end;
  touching_revision_ = revision;
  if (!near_.find(positions, layers().thickness(), pool)) {
    touching_.clear();
    touching_at_.clear();
    return touching_;
  }
  energies_.find(positions, near_, touching_);
  if (obstacles_) {
    const ObstacleSurfaces& surfaces = obstacles_->surfaces();
    obstacles_->find(positions, at_end ? surfaces.atEnd() : surfaces.atBegin(),
                     0.5 * layers().thickness(), pool);
    energies_.findOfObstacles(positions, *obstacles_, at_end, touching_);
  }
  touching_at_ = positions;
  return touching_;
}

double SelfContact::frictionOf(const PairEnergy& pair) const {
  const double friction = layers().friction(pair.fabrics[0], pair.fabrics[1]);
  return pair.obstacle < 0 ? friction : obstacle_friction_[pair.obstacle].value_or(friction);
}

/// m/s, of both sides of a pair against each other.
Vector3d SelfContact::velocityOf(const PairEnergy& pair, const Velocities& velocities) const {
  const Vector3d sum = weightedSum(pair, velocities);
  if (pair.obstacle < 0 || pair.way.isZero(0.0)) return sum;
  return sum - pair.way / obstacles_->surfaces().timeStep();
}

/// N, on the weighted sum of its vertices.
Vector3d SelfContact::frictionAt(const PairEnergy& pair, const Velocities& velocities) const {
  if (!(pair.force > 0.0)) return Vector3d::Zero();
  const Vector3d speed = tangential(velocityOf(pair, velocities), pair.normal);
  return -frictionOf(pair) * pair.force * smoothed(speed.norm(), kSlipSpeed).secant * speed;
}

double SelfContact::energy(const ForceState& state) const {
  double energy = 0.0;
  for (const PairEnergy& pair : touching(state.positions, isEnd(state.time), state.pool)) {
    energy += pair.energy;
  }
  return touching_at_.empty() ? std::numeric_limits<double>::quiet_NaN() : energy;
}

void SelfContact::addForces(const ForceState& state, std::vector<Vector3d>& forces) const {
  for (const PairEnergy& pair : touching(state.positions, isEnd(state.time), state.pool)) {
    const Vector3d friction = frictionAt(pair, state.velocities);
    for (int i = 0; i < pair.count; ++i) {
      forces[pair.vertices[i]] += pair.weights[i] * friction - pair.gradient(i);
    }
  }
}

Vector3d SelfContact::forceOn(int obstacle, const ForceState& state) const {
  Vector3d sum = Vector3d::Zero();
  for (const PairEnergy& pair : touching(state.positions, isEnd(state.time), state.pool)) {
    if (pair.obstacle != obstacle) continue;
    sum -= pair.force * pair.normal + frictionAt(pair, state.velocities);
  }
  return sum;
}

double SelfContact::obstacleWork(const ForceState& end) const {
  if (!obstacles_ || !obstacles_->surfaces().moved()) return 0.0;
  double work = 0.0;
  for (const PairEnergy& pair : touching(end.positions, true, end.pool)) {
    if (pair.obstacle < 0) continue;
    work += (pair.force * pair.normal + frictionAt(pair, end.velocities)).dot(pair.way);
  }
  return work;
}

void SelfContact::addJacobian(const ForceState& state, JacobianRows& rows) const {
  constexpr double kWay = 1e-8, kSpeed = 1e-6;  // m, m/s
  std::vector<int> moved;
  for (const PairEnergy& pair : touching(state.positions, isEnd(state.time), state.pool)) {
    moved.insert(moved.end(), pair.vertices.begin(), pair.vertices.begin() + pair.count);
  }
  std::sort(moved.begin(), moved.end());
  moved.erase(std::unique(moved.begin(), moved.end()), moved.end());
  Positions positions = state.positions;
  Velocities velocities = state.velocities;
  std::vector<Vector3d> above(positions.size()), below(positions.size());
  const auto differentiate = [&](double& number, double change, std::vector<Matrix3d>& blocks,
                                 int axis) {
    const double middle = number;
    const ForceState changed = {positions, velocities, state.time, state.memory};
    std::fill(above.begin(), above.end(), Vector3d::Zero());
    std::fill(below.begin(), below.end(), Vector3d::Zero());
    number = middle + change;
    addForces(changed, above);
    number = middle - change;
    addForces(changed, below);
    number = middle;
    for (int row : moved) blocks[row].col(axis) = (above[row] - below[row]) / (2.0 * change);
  };
  std::vector<Matrix3d> by_position(positions.size()), by_velocity(positions.size());
  for (int column : moved) {
    for (int axis = 0; axis < 3; ++axis) {
      differentiate(positions[column][axis], kWay, by_position, axis);
      differentiate(velocities[column][axis], kSpeed, by_velocity, axis);
    }
    for (int row : moved) {
      if (by_position[row].isZero(0.0) && by_velocity[row].isZero(0.0)) continue;
      rows.add(row, column, by_position[row], by_velocity[row]);
    }
  }
}

/// The energies' part of a linear system, about what has been reached.
void SelfContact::addEnergies(const std::vector<PairEnergy>& pairs, double a,
                              linear::SymmetricBlockMatrix& matrix,
                              linear::BlockVector& rhs) const {
  for (const PairEnergy& pair : pairs) {
    for (int i = 0; i < pair.count; ++i) rhs.col(pair.vertices[i]) -= a * pair.gradient(i);
    if (pair.stiffness > 0.0) {
      addBlocks(pair, a * a * pair.stiffness * pair.normal * pair.normal.transpose(), matrix);
    }
  }
}

void SelfContact::assembleLinearised(const ForceState& state, const StageTimes& times,
                                     linear::SymmetricBlockMatrix& matrix,
                                     linear::BlockVector& rhs) const {
  const std::vector<PairEnergy>& pairs = touching(state.positions, false, state.pool);
  addEnergies(pairs, times.a, matrix, rhs);
  for (const PairEnergy& pair : pairs) {
    const Vector3d velocity = velocityOf(pair, state.velocities);
    Vector3d impulse =
        -times.a * times.ahead * pair.stiffness * pair.normal.dot(velocity) * pair.normal;
    if (pair.force > 0.0) {
      const Vector3d speed = tangential(velocity, pair.normal);
      const double damping =
          times.a * frictionOf(pair) * pair.force * smoothed(speed.norm(), kSlipSpeed).secant;
      impulse -= damping * speed;
      const Matrix3d across = Matrix3d::Identity() - pair.normal * pair.normal.transpose();
      addBlocks(pair, damping * across, matrix);
    }
    for (int i = 0; i < pair.count; ++i) rhs.col(pair.vertices[i]) += pair.weights[i] * impulse;
  }
  for (const TangleLink& link : links_) {
    const double damping = times.a * link.damping;
    const Vector3d impulse = -damping * weightedSum(link, state.velocities);
    for (int i = 0; i < link.count; ++i) rhs.col(link.vertices[i]) += link.weights[i] * impulse;
    addBlocks(link, damping * Matrix3d::Identity(), matrix);
  }
}

void SelfContact::hold(const NewtonStart& start, Vector3d* /*held*/) const {
  held_.clear();
  held_links_.clear();
  for (const TangleLink& link : links_) held_links_.push_back(weightedSum(link, start.base));
  for (const PairEnergy& pair : touching(start.at.positions, !start.passive, start.at.pool)) {
    if (!(pair.force > 0.0)) continue;
    held_.push_back({pair.count, pair.vertices, pair.weights, pair.normal,
                     frictionOf(pair) * pair.force, weightedSum(pair, start.base) + pair.way});
  }
}

void SelfContact::assembleNewton(const ForceState& state, const Vector3d* /*held*/, double a,
                                 Hessian /*hessian*/, linear::SymmetricBlockMatrix& matrix,
                                 linear::BlockVector& rhs) const {
  addEnergies(touching(state.positions, true, state.pool), a, matrix, rhs);
  for (const HeldFriction& pair : held_) {
    const Vector3d slip = tangential(weightedSum(pair, state.positions) - pair.start, pair.normal);
    const double way = slip.norm();
    const Smoothed friction = smoothed(way, kSlipSpeed * a);
    for (int i = 0; i < pair.count; ++i) {
      rhs.col(pair.vertices[i]) -= a * pair.most * friction.secant * pair.weights[i] * slip;
    }
    Matrix3d block =
        friction.secant * (Matrix3d::Identity() - pair.normal * pair.normal.transpose());
    if (way > 0.0) {
      block += (friction.slope - friction.secant) / (way * way) * slip * slip.transpose();
    }
    addBlocks(pair, a * a * pair.most * block, matrix);
  }
  for (std::size_t l = 0; l < links_.size(); ++l) {
    const Vector3d way = weightedSum(links_[l], state.positions) - held_links_[l];
    for (int i = 0; i < links_[l].count; ++i) {
      rhs.col(links_[l].vertices[i]) -= links_[l].damping * links_[l].weights[i] * way;
    }
    addBlocks(links_[l], a * links_[l].damping * Matrix3d::Identity(), matrix);
  }
}

double SelfContact::incrementalPotential(const ForceState& state, const Vector3d* /*held*/,
                                         double a) const {
  double potential = energy(state);
  for (const HeldFriction& pair : held_) {
    const Vector3d slip = tangential(weightedSum(pair, state.positions) - pair.start, pair.normal);
    potential += pair.most * smoothed(slip.norm(), kSlipSpeed * a).potential;
  }
  for (std::size_t l = 0; l < links_.size(); ++l) {
    const Vector3d way = weightedSum(links_[l], state.positions) - held_links_[l];
    potential += 0.5 * links_[l].damping / a * way.squaredNorm();
  }
  return potential;
}

}  // namespace haptex::cloth
