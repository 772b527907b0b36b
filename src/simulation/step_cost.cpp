#include "haptex/simulation/step_cost.h"

#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <stdexcept>
#include <utility>

namespace haptex::simulation {
namespace {

constexpr double kStroke = 0.4;  // s, from one side to the other
constexpr double kWidth = 0.02;  // m
constexpr double kSoon = 1e-9;   // s, for rounding of times

}  // namespace

std::size_t allocatedBytes() {
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

double threadSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

SteppedScene::SteppedScene(const scene::Scene& scene, std::vector<material::Fabric> fabrics)
    : cloth_(scene.mesh, std::move(fabrics), scene.effects),
      start_(cloth_.initialState()),
      state_(start_),
      collision_(scene.effects.contacts
                     ? std::make_optional<contact::ObstacleCollision>(cloth_, scene.obstacles)
                     : std::nullopt),
      integrator_(cloth_, scene.step),
      attached_(scene.attached_particles),
      time_step_(scene.time_step) {
  restart();
}

void SteppedScene::restart() {
  state_ = start_;
  strokes_ = 0;
  shake();
}

/// The next stroke, to the other side than the last one.
void SteppedScene::shake() {
  const double sign = strokes_ % 2 == 0 ? 1.0 : -1.0;
  for (const int particle : attached_) {
    cloth_.attach(particle,
                  {state_.positions[particle], {sign * kWidth, 0.0, 0.0}, state_.time, kStroke});
  }
  ++strokes_;
}

void SteppedScene::step() {
  if (state_.time > kPeriod - kSoon) restart();
  if (state_.time > strokes_ * kStroke - kSoon) shake();
  const cloth::StepReport report = collision_
                                       ? collision_->step(cloth_, integrator_, state_, time_step_)
                                       : integrator_.step(cloth_, state_, time_step_);
  if (!report.accepted) throw std::runtime_error("a step was not finite and was rejected");
}

double SteppedScene::secondsFor(int steps) {
  restart();
  const double begin = threadSeconds();
  for (int i = 0; i < steps; ++i) step();
  return threadSeconds() - begin;
}

StepCost compareSteps(SteppedScene& scene, SteppedScene& base, int rounds, int steps) {
  base.secondsFor(steps);  // memory and processor get used to both
  scene.secondsFor(steps);
  double shortest = HUGE_VAL;
  std::vector<double> bases;
  for (int round = 0; round < rounds; ++round) {
    bases.push_back(base.secondsFor(steps));
    shortest = std::min(shortest, scene.secondsFor(steps));
    bases.push_back(base.secondsFor(steps));
  }
  std::sort(bases.begin(), bases.end());
  return {shortest / steps, shortest / bases.front(),
          bases[bases.size() / 4] / bases.front() - 1.0};
}

}  // namespace haptex::simulation
