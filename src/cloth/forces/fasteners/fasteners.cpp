#include "haptex/cloth/forces/fasteners/fasteners.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "haptex/base/quoted.h"
#include "haptex/base/require.h"

namespace haptex::cloth {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kWeightTolerance = 1e-6;  // of their sum

std::string called(const Fastener& fastener) { return "fastener " + base::quoted(fastener.name); }

void requirePlace(const Fastener& fastener, const ClothPlace& place, std::size_t particles) {
  double sum = 0.0;
  for (int i = 0; i < 3; ++i) {
    const double weight = place.weights[i];
    if (!std::isfinite(weight)) {
      base::refuse(called(fastener), ": a weight is ", weight, "; allowed are finite numbers");
    }
    sum += weight;
    const int particle = place.particles[i];
    const bool exists = particle >= 0 && static_cast<std::size_t>(particle) < particles;
    if (weight == 0.0 || exists) continue;
    base::refuse(called(fastener), ": particle ", particle, " does not exist; allowed are 0 to ",
                 particles - 1);
  }
  if (std::abs(sum - 1.0) <= kWeightTolerance) return;
  base::refuse(called(fastener), ": the weights of a place sum to ", sum, "; allowed is 1 within ",
               kWeightTolerance);
}

void requireSound(const Fastener& fastener, std::size_t particles) {
  for (const ClothPlace& place : fastener.places) requirePlace(fastener, place, particles);
  const auto require = [&](bool holds, const char* what, double value, const char* unit,
                           const char* allowed) {
    if (std::isfinite(value) && holds) return;
    base::refuse(called(fastener), ": ", what, " = ", value, " ", unit,
                 "; allowed are finite numbers ", allowed);
  };
  require(fastener.stiffness > 0.0, "stiffness", fastener.stiffness, "N/m", "> 0");
  require(fastener.length >= 0.0, "length", fastener.length, "m", ">= 0");
  require(fastener.release_force > 0.0, "release force", fastener.release_force, "N", "> 0");
}

}  // namespace

Fasteners::Fasteners(std::vector<Fastener> fasteners, std::size_t particles, double thickness)
    : fasteners_(std::move(fasteners)) {
  std::set<std::string> names;
  for (const Fastener& fastener : fasteners_) {
    if (!names.insert(fastener.name).second) {
      base::refuse(called(fastener), ": there is another one of this name; allowed is each once");
    }
    links_.push_back(linkOf(fastener, particles, thickness));
  }
}

Fasteners::Link Fasteners::linkOf(const Fastener& fastener, std::size_t particles,
                                  double thickness) {
  constexpr double kNone = 1e-12;  // weights that are rounding
  requireSound(fastener, particles);
  std::map<int, double> weights;
  for (int side : {0, 1}) {
    const ClothPlace& place = fastener.places[side];
    for (int i = 0; i < 3; ++i) {
      if (place.weights[i] == 0.0) continue;
      weights[place.particles[i]] += (side == 0 ? -1.0 : 1.0) * place.weights[i];
    }
  }
  Link link;
  link.length = std::max(fastener.length, thickness);
  for (const auto& [particle, weight] : weights) {
    if (std::abs(weight) <= kNone) continue;
    link.particles[link.count] = particle;
    link.weights[link.count++] = weight;
  }
  if (link.count == 0) {
    base::refuse(called(fastener), ": both places are the same; allowed are two that differ");
  }
  return link;
}

Vector3d Fasteners::extent(const Link& link, const std::vector<Vector3d>& vectors) const {
  Vector3d sum = Vector3d::Zero();
  for (int i = 0; i < link.count; ++i) sum += link.weights[i] * vectors[link.particles[i]];
  return sum;
}

double Fasteners::reach(std::size_t fastener) const {
  const Fastener& its = fasteners_[fastener];
  return links_[fastener].length + its.release_force / its.stiffness;
}

double Fasteners::distance(std::size_t fastener, const Positions& positions) const {
  return extent(links_[fastener], positions).norm();
}

double Fasteners::tension(std::size_t fastener, const Positions& positions) const {
  return tensionAt(fastener, distance(fastener, positions));
}

double Fasteners::tensionAt(std::size_t fastener, double distance) const {
  const Fastener& its = fasteners_[fastener];
  const double stretch = distance - links_[fastener].length;
  return stretch <= 0.0 ? 0.0 : std::min(its.stiffness * stretch, its.release_force);
}

void Fasteners::requireWithinReach(std::size_t fastener, const Positions& positions) const {
  const double apart = distance(fastener, positions), most = reach(fastener);
  if (apart <= most) return;
  base::refuse(called(fasteners_[fastener]), " cannot be fastened: its places are ",
               base::shortNumber(apart), " m apart; allowed are ", base::shortNumber(most),
               " m, beyond which it opens");
}

bool Fasteners::isFastened(std::size_t fastener, const double* memory) {
  return memory[2 * fastener] != 0.0;
}

double Fasteners::openedAt(std::size_t fastener, const double* memory) {
  return memory[2 * fastener + 1];
}

void Fasteners::set(std::size_t fastener, bool fastened, double* memory) {
  memory[2 * fastener] = fastened ? 1.0 : 0.0;
  memory[2 * fastener + 1] = 0.0;
}

std::vector<std::array<int, 2>> Fasteners::pairs() const {
  std::vector<std::array<int, 2>> result;
  for (const Link& link : links_) {
    for (int i = 1; i < link.count; ++i) {
      for (int j = 0; j < i; ++j) result.push_back({link.particles[j], link.particles[i]});
    }
  }
  return result;
}

void Fasteners::bind(const linear::SymmetricBlockMatrix& matrix) {
  for (Link& link : links_) {
    auto slot = link.slots.begin();
    for (int i = 1; i < link.count; ++i) {
      for (int j = 0; j < i; ++j) *slot++ = matrix.slot(link.particles[i], link.particles[j]);
    }
  }
}

std::vector<std::vector<int>> Fasteners::memoryOwners() const {
  std::vector<std::vector<int>> owners;
  for (const Link& link : links_) {
    const std::vector<int> its(link.particles.begin(), link.particles.begin() + link.count);
    owners.insert(owners.end(), 2, its);
  }
  return owners;
}

void Fasteners::forget(const Positions& /*positions*/, double* memory) const {
  for (std::size_t f = 0; f < fasteners_.size(); ++f) set(f, fasteners_[f].fastened, memory);
}

void Fasteners::remember(const Positions& positions, double* memory) const {
  for (std::size_t f = 0; f < fasteners_.size(); ++f) {
    if (!isFastened(f, memory) || distance(f, positions) <= reach(f)) continue;
    set(f, false, memory);
    memory[2 * f + 1] = tension(f, positions);
  }
}

Vector3d Fasteners::pull(std::size_t fastener, const Vector3d& extent) const {
  const double distance = extent.norm();
  const double tension = tensionAt(fastener, distance);
  return tension > 0.0 ? Vector3d(tension / distance * extent) : Vector3d(Vector3d::Zero());
}

/// By the extent d of length r, with n = d / r and tension f(r), the pull f n has the derivative
///   f' n n^T + f / r (1 - n n^T).
Fasteners::Response Fasteners::respond(std::size_t fastener, const Vector3d& extent) const {
  const Fastener& its = fasteners_[fastener];
  const double length = links_[fastener].length;
  const double distance = extent.norm();
  Response response{pull(fastener, extent), Matrix3d::Zero()};
  if (distance < length) return response;
  if (distance == 0.0) {  // without length it is the same in all directions
    response.stiffness.diagonal().setConstant(its.stiffness);
    return response;
  }
  const double across = tensionAt(fastener, distance) / distance;
  const double along = distance <= reach(fastener) ? its.stiffness : 0.0;
  const Vector3d normal = extent / distance;
  response.stiffness = (along - across) * normal * normal.transpose();
  response.stiffness.diagonal().array() += across;
  return response;
}

void Fasteners::addForces(const ForceState& state, std::vector<Vector3d>& forces) const {
  for (std::size_t f = 0; f < links_.size(); ++f) {
    if (!isFastened(f, state.memory)) continue;
    const Link& link = links_[f];
    const Vector3d its = pull(f, extent(link, state.positions));
    for (int i = 0; i < link.count; ++i) forces[link.particles[i]] -= link.weights[i] * its;
  }
}

double Fasteners::energy(const ForceState& state) const {
  double energy = 0.0;
  for (std::size_t f = 0; f < links_.size(); ++f) {
    if (!isFastened(f, state.memory)) continue;
    const Fastener& its = fasteners_[f];
    const double stretch = std::max(0.0, distance(f, state.positions) - links_[f].length);
    const double elastic = std::min(stretch, its.release_force / its.stiffness);
    energy += 0.5 * its.stiffness * elastic * elastic + its.release_force * (stretch - elastic);
  }
  return energy;
}

void Fasteners::addJacobian(const ForceState& state, JacobianRows& rows) const {
  for (std::size_t f = 0; f < links_.size(); ++f) {
    if (!isFastened(f, state.memory)) continue;
    const Link& link = links_[f];
    const Matrix3d stiffness = respond(f, extent(link, state.positions)).stiffness;
    for (int i = 0; i < link.count; ++i) {
      for (int j = 0; j < link.count; ++j) {
        rows.add(link.particles[i], link.particles[j],
                 -link.weights[i] * link.weights[j] * stiffness);
      }
    }
  }
}

void Fasteners::assembleLinearised(const ForceState& state, const StageTimes& times,
                                   linear::SymmetricBlockMatrix& matrix,
                                   linear::BlockVector& rhs) const {
  for (std::size_t f = 0; f < links_.size(); ++f) {
    if (!isFastened(f, state.memory)) continue;
    const Link& link = links_[f];
    const Response response = respond(f, extent(link, state.positions));
    Vector3d impulse = times.a * response.pull;
    if (times.ahead != 0.0) {
      impulse += times.a * times.ahead * response.stiffness * extent(link, state.velocities);
    }
    const Matrix3d stiffness = times.a * times.a * response.stiffness;
    auto slot = link.slots.begin();
    for (int i = 0; i < link.count; ++i) {
      rhs.col(link.particles[i]) -= link.weights[i] * impulse;
      matrix.diagonal(link.particles[i]) += link.weights[i] * link.weights[i] * stiffness;
      for (int j = 0; j < i; ++j) {
        matrix.lower(*slot++) += link.weights[i] * link.weights[j] * stiffness;
      }
    }
  }
}

}  // namespace haptex::cloth
