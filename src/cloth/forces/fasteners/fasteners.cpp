#include "haptex/cloth/forces/fasteners/fasteners.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <utility>

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
  const std::size_t most = fastener.kind == FastenerKind::kDrawstring ? Fasteners::kMostPlaces : 2;
  if (fastener.places.size() < 2 || fastener.places.size() > most) {
    base::refuse(called(fastener), " has ", fastener.places.size(), " places; allowed are ",
                 most == 2 ? "2" : "2 to " + std::to_string(most));
  }
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
  const std::size_t segments = fastener.places.size() - 1;
  std::map<int, Eigen::VectorXd> weights;
  for (std::size_t s = 0; s < segments; ++s) {
    for (int side : {0, 1}) {
      const ClothPlace& place = fastener.places[s + side];
      for (int i = 0; i < 3; ++i) {
        if (place.weights[i] == 0.0) continue;
        const auto [its, is_new] = weights.try_emplace(place.particles[i]);
        if (is_new) its->second.setZero(static_cast<Eigen::Index>(segments));
        its->second[static_cast<Eigen::Index>(s)] += (side == 0 ? -1.0 : 1.0) * place.weights[i];
      }
    }
  }
  Link link;
  link.length = std::max(fastener.length, static_cast<double>(segments) * thickness);
  if (fastener.kind == FastenerKind::kDrawstring) link.rounding = kRounding;
  for (auto its = weights.begin(); its != weights.end();) {
    its->second = (its->second.array().abs() <= kNone).select(0.0, its->second);
    its = its->second.isZero(0.0) ? weights.erase(its) : std::next(its);
  }
  link.weights.resize(static_cast<Eigen::Index>(segments),
                      static_cast<Eigen::Index>(weights.size()));
  for (const auto& [particle, its] : weights) {
    link.weights.col(static_cast<Eigen::Index>(link.particles.size())) = its;
    link.particles.push_back(particle);
  }
  if (link.particles.empty() || (link.weights.array() == 0.0).rowwise().all().any()) {
    base::refuse(called(fastener), segments == 1
                                       ? ": both places are the same; allowed are two that differ"
                                       : ": two places in a row are the same; allowed are places "
                                         "that differ from the one before");
  }
  return link;
}

Vector3d Fasteners::extent(const Link& link, int segment, const std::vector<Vector3d>& vectors) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < link.particles.size(); ++i) {
    sum += link.weights(segment, static_cast<Eigen::Index>(i)) * vectors[link.particles[i]];
  }
  return sum;
}

Fasteners::Course Fasteners::courseOf(const Link& link, const Positions& positions) {
  Course course;
  const auto segments = static_cast<int>(link.weights.rows());
  course.directions.resize(3, segments);
  course.curvatures.resize(segments);
  for (int s = 0; s < segments; ++s) {
    const Vector3d its = extent(link, s, positions);
    const double distance = std::hypot(its.norm(), link.rounding);
    course.distance += distance;
    course.curvatures[s] = distance > 0.0 ? 1.0 / distance : 0.0;
    course.directions.col(s) = course.curvatures[s] * its;
  }
  return course;
}

/// Derivative of the distance by the position of a particle of the link.
Vector3d Fasteners::directionAt(const Link& link, const Course& course, int particle) {
  return course.directions * link.weights.col(particle);
}

/// Derivative of the pull on particle i of the link by the position of particle j. With the
/// distance D of all segments, their weights w and the tension f(D),
///   f' (dD/di) (dD/dj)^T + f sum over segments of w_i w_j (1 - n n^T) / r.
Matrix3d Fasteners::stiffness(const Link& link, const Course& course, const Response& response,
                              int i, int j) {
  Matrix3d sum =
      response.slope * directionAt(link, course, i) * directionAt(link, course, j).transpose();
  for (int s = 0; s < course.curvatures.size(); ++s) {
    const double weight = link.weights(s, i) * link.weights(s, j);
    if (weight == 0.0) continue;
    if (course.curvatures[s] == 0.0) {  // without length it is the same in all directions
      sum.diagonal().array() += weight * response.slope;
      continue;
    }
    const double across = weight * response.tension * course.curvatures[s];
    const auto direction = course.directions.col(s);
    sum -= across * direction * direction.transpose();
    sum.diagonal().array() += across;
  }
  return sum;
}

double Fasteners::reach(std::size_t fastener) const {
  const Fastener& its = fasteners_[fastener];
  return links_[fastener].length + its.release_force / its.stiffness;
}

double Fasteners::distance(std::size_t fastener, const Positions& positions) const {
  return courseOf(links_[fastener], positions).distance;
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
    for (std::size_t i = 1; i < link.particles.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) result.push_back({link.particles[j], link.particles[i]});
    }
  }
  return result;
}

void Fasteners::bind(const linear::SymmetricBlockMatrix& matrix) {
  for (Link& link : links_) {
    link.slots.clear();
    for (std::size_t i = 1; i < link.particles.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        link.slots.push_back(matrix.slot(link.particles[i], link.particles[j]));
      }
    }
  }
}

std::vector<std::vector<int>> Fasteners::memoryOwners() const {
  std::vector<std::vector<int>> owners;
  for (const Link& link : links_) owners.insert(owners.end(), 2, link.particles);
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

Fasteners::Response Fasteners::respond(std::size_t fastener, double distance) const {
  const bool elastic = distance >= links_[fastener].length && distance <= reach(fastener);
  return {elastic ? fasteners_[fastener].stiffness : 0.0, tensionAt(fastener, distance)};
}

void Fasteners::addForces(const ForceState& state, std::vector<Vector3d>& forces) const {
  for (std::size_t f = 0; f < links_.size(); ++f) {
    if (!isFastened(f, state.memory)) continue;
    const Link& link = links_[f];
    const Course course = courseOf(link, state.positions);
    const double tension = tensionAt(f, course.distance);
    for (std::size_t i = 0; i < link.particles.size(); ++i) {
      forces[link.particles[i]] -= tension * directionAt(link, course, static_cast<int>(i));
    }
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
    const Course course = courseOf(link, state.positions);
    const Response response = respond(f, course.distance);
    const auto count = static_cast<int>(link.particles.size());
    for (int i = 0; i < count; ++i) {
      for (int j = 0; j < count; ++j) {
        rows.add(link.particles[i], link.particles[j], -stiffness(link, course, response, i, j));
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
    const Course course = courseOf(link, state.positions);
    const Response response = respond(f, course.distance);
    const auto count = static_cast<int>(link.particles.size());
    auto slot = link.slots.begin();
    for (int i = 0; i < count; ++i) {
      const int particle = link.particles[i];
      rhs.col(particle) -= times.a * response.tension * directionAt(link, course, i);
      matrix.diagonal(particle) += times.a * times.a * stiffness(link, course, response, i, i);
      for (int j = 0; j < i; ++j) {
        matrix.lower(*slot++) += times.a * times.a * stiffness(link, course, response, i, j);
      }
      if (times.ahead == 0.0) continue;
      for (int j = 0; j < count; ++j) {
        rhs.col(particle) -= times.a * times.ahead * stiffness(link, course, response, i, j) *
                             state.velocities[link.particles[j]];
      }
    }
  }
}

}  // namespace haptex::cloth
