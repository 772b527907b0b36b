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
  for (int s = 0; s < segments; ++s) {
    const Vector3d its = extent(link, s, positions);
    const double distance = std::hypot(its.norm(), link.rounding);
    course.distance += distance;
    course.curvatures[s] = distance > 0.0 ? 1.0 / distance : 0.0;
    course.directions.col(s) = course.curvatures[s] * its;
  }
  return course;
}

/// Derivative of the pulls of all segments by time (N/s).
Fasteners::Segments Fasteners::pullRates(const Link& link, const Course& course,
                                         const Response& response,
                                         const std::vector<Vector3d>& velocities) {
  const auto segments = static_cast<int>(course.directions.cols());
  Segments rates(3, segments);
  double rate = 0.0;  // m/s, of the distance
  for (int s = 0; s < segments; ++s) {
    rates.col(s) = extent(link, s, velocities);
    rate += course.directions.col(s).dot(rates.col(s));
  }
  for (int s = 0; s < segments; ++s) {
    const Vector3d its = response.stiffnesses[s] * rates.col(s);
    rates.col(s) = its + response.slope * rate * course.directions.col(s);
  }
  return rates;
}

/// Calls take(i, j, derivative of the pull on the link's particle i by the position of its particle
/// j) for i and all j <= i. With the distance D of all segments, their weights w and the tension
/// f(D), it is
///   f' (dD/di) (dD/dj)^T + f sum over segments of w_i w_j (1 - n n^T) / r.
template <typename Take>
void Fasteners::forEachBlock(const Link& link, const Course& course, const Response& response,
                             const Take& take) {
  // dD/di of every particle.
  Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, 3 * kMostPlaces> gradients;
  gradients = course.directions.lazyProduct(link.weights);
  for (int i = 0; i < gradients.cols(); ++i) {
    for (int j = 0; j <= i; ++j) {
      Matrix3d block = response.slope * gradients.col(i) * gradients.col(j).transpose();
      for (int s = 0; s < link.weights.rows(); ++s) {
        const double weight = link.weights(s, i) * link.weights(s, j);
        if (weight != 0.0) block += weight * response.stiffnesses[s];
      }
      take(i, j, block);
    }
  }
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

Fasteners::Response Fasteners::respond(std::size_t fastener, const Course& course) const {
  const double distance = course.distance;
  const bool elastic = distance >= links_[fastener].length && distance <= reach(fastener);
  Response response;
  response.tension = tensionAt(fastener, distance);
  response.slope = elastic ? fasteners_[fastener].stiffness : 0.0;
  for (int s = 0; s < course.directions.cols(); ++s) {
    const auto direction = course.directions.col(s);
    const double across = response.tension * course.curvatures[s];
    Matrix3d& stiffness = response.stiffnesses[s];
    stiffness = -across * direction * direction.transpose();
    // Without length it is the same in all directions.
    stiffness.diagonal().array() += course.curvatures[s] == 0.0 ? response.slope : across;
  }
  return response;
}

void Fasteners::addForces(const ForceState& state, std::vector<Vector3d>& forces) const {
  for (std::size_t f = 0; f < links_.size(); ++f) {
    if (!isFastened(f, state.memory)) continue;
    const Link& link = links_[f];
    const Course course = courseOf(link, state.positions);
    const double tension = tensionAt(f, course.distance);
    for (std::size_t i = 0; i < link.particles.size(); ++i) {
      forces[link.particles[i]] -=
          tension * (course.directions * link.weights.col(static_cast<Eigen::Index>(i)));
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
    forEachBlock(link, course, respond(f, course), [&](int i, int j, const Matrix3d& block) {
      rows.add(link.particles[i], link.particles[j], -block);
      if (i != j) rows.add(link.particles[j], link.particles[i], -block.transpose());
    });
  }
}

void Fasteners::assembleLinearised(const ForceState& state, const StageTimes& times,
                                   linear::SymmetricBlockMatrix& matrix,
                                   linear::BlockVector& rhs) const {
  for (std::size_t f = 0; f < links_.size(); ++f) {
    if (!isFastened(f, state.memory)) continue;
    const Link& link = links_[f];
    const Course course = courseOf(link, state.positions);
    const Response response = respond(f, course);
    Segments impulses = times.a * response.tension * course.directions;
    if (times.ahead != 0.0) {
      impulses += times.a * times.ahead * pullRates(link, course, response, state.velocities);
    }
    for (std::size_t i = 0; i < link.particles.size(); ++i) {
      rhs.col(link.particles[i]) -= impulses * link.weights.col(static_cast<Eigen::Index>(i));
    }
    auto slot = link.slots.begin();
    forEachBlock(link, course, response, [&](int i, int j, const Matrix3d& block) {
      if (i == j) {
        matrix.diagonal(link.particles[i]) += times.a * times.a * block;
      } else {
        matrix.lower(*slot++) += times.a * times.a * block;
      }
    });
  }
}

}  // namespace haptex::cloth
