#include "haptex/contact/held_fingertip.h"

#include <algorithm>
#include <cmath>

namespace haptex::contact {
namespace {

using Eigen::Vector3d;

// Of the core: what lies beside the particle that has stopped it does not stop it from sliding.
constexpr double kSlack = 0.01;

/// Where the core first meets a particle.
struct Meeting {
  double share = 1.0;  // of the way, 1: it meets none
  Vector3d normal;     // unit, from the centre to the particle
};

/// How a core moves.
struct Sweep {
  Vector3d begin, way;  // m, of the core's centre
  double core;          // m, its radius

  /// The first share of the way at which a particle is on the core, or in it and not left behind.
  void meet(const Vector3d& place, Meeting& first) const {
    const Vector3d offset = place - begin;
    const double ahead = offset.dot(way);
    const double outside = offset.squaredNorm() - core * core;
    double share = 0.0;
    if (outside > 0.0) {
      const double squared = way.squaredNorm();
      const double root = ahead * ahead - squared * outside;
      if (ahead <= 0.0 || root < 0.0) return;
      share = (ahead - std::sqrt(root)) / squared;
    } else if (ahead < 0.0) {
      return;
    }
    if (!(share < first.share)) return;
    first.share = share;
    first.normal = (offset - share * way).normalized();
  }
};

/// From the centre to what it presses on, by force.
Vector3d meanNormal(const std::vector<TouchedParticle>& touched, const Vector3d& without) {
  Vector3d sum = Vector3d::Zero();
  for (const TouchedParticle& point : touched) sum += point.normal_force * point.normal;
  return sum.isZero(0.0) ? without : sum.normalized();
}

/// Of what it presses on, by force (m/s): what holds it neither approaches it nor leaves.
Vector3d meanVelocity(const std::vector<TouchedParticle>& touched, const Particles& particles) {
  Vector3d sum = Vector3d::Zero();
  double forces = 0.0;
  for (const TouchedParticle& point : touched) {
    sum += point.normal_force * particles.velocities[point.particle];
    forces += point.normal_force;
  }
  return forces > 0.0 ? Vector3d(sum / forces) : sum;
}

/// How far a core that is held slides: friction holds it, too, until it is drawn along the cloth by
/// more than its share of how far it is pushed in.
Vector3d slide(const Vector3d& rest, const Vector3d& normal, double friction) {
  const Vector3d along = rest - normal.dot(rest) * normal;
  const double length = along.norm();
  const double held = friction * std::max(0.0, normal.dot(rest));
  return length > held ? Vector3d((1.0 - held / length) * along) : Vector3d(Vector3d::Zero());
}

}  // namespace

const Fingertip& HeldFingertip::follow(const Fingertip& next) {
  held_ = next;
  is_held_ = sweeps_all_ = false;
  return *held_;
}

void HeldFingertip::sweepFrom(const std::optional<Vector3d>& place) {
  if (!held_) return;
  if (place && !is_held_) held_->position = *place;
  sweeps_all_ = true;
}

const Fingertip& HeldFingertip::move(const Fingertip& next, const Particles& particles,
                                     const std::vector<TouchedParticle>& touched, double reach,
                                     double friction) {
  if (!held_ || (next.position - held_->position).norm() > kLongest) return follow(next);
  const double deepest = kDeepest * next.radius;
  const Vector3d begin = held_->position;
  const bool all = sweeps_all_ || (next.position - begin).norm() > deepest;
  const double core = reach - deepest;
  Sweep sweep{begin, next.position - begin, core};
  const auto for_each = [&](const auto& look_at) {
    for (std::size_t i = 0; i < (all ? particles.count : touched.size()); ++i) {
      look_at(particles.positions[all ? i : touched[i].particle]);
    }
  };
  const auto first_meeting = [&] {
    Meeting first;
    for_each([&](const Vector3d& place) { sweep.meet(place, first); });
    return first;
  };
  const Meeting first = first_meeting();
  is_held_ = first.share < 1.0;
  if (!is_held_) return follow(next);
  const Vector3d stop = begin + first.share * sweep.way;
  const Vector3d normal = meanNormal(touched, first.normal);
  sweep.begin = stop;
  sweep.core = (1.0 - kSlack) * core;
  sweep.way = slide(next.position - stop, normal, friction);
  Vector3d place = stop + first_meeting().share * sweep.way;
  double inside = 0.0;  // m, of cloth that comes back
  for_each([&](const Vector3d& particle) {
    inside = std::max(inside, core - (particle - place).norm());
  });
  place -= inside * normal;
  held_ = next;
  held_->position = place;
  held_->velocity = meanVelocity(touched, particles);
  sweeps_all_ = false;
  return *held_;
}

}  // namespace haptex::contact
