#include "haptex/scene/body_values.h"

#include <algorithm>
#include <string>

#include "haptex/contact/obstacles/obstacle_collision.h"

namespace haptex::scene {

using base::YamlValue;

void requireBodiesKnown(const YamlValue& file, const std::vector<mesh::Obstacle>& obstacles,
                        const cloth::ModelledEffects& effects, cloth::IntegrationMethod method) {
  const auto bodies = static_cast<std::size_t>(
      std::count_if(obstacles.begin(), obstacles.end(),
                    [](const mesh::Obstacle& obstacle) { return obstacle.body.has_value(); }));
  if (bodies == 0) return;
  const YamlValue list = file.at("obstacles");
  if (bodies > contact::ObstacleCollision::kMostBodies) {
    list.refuseBecause("has " + std::to_string(bodies) + " obstacles with body, at most " +
                       std::to_string(contact::ObstacleCollision::kMostBodies) + " are allowed");
  }
  if (!effects.contacts) {
    list.refuseBecause("has a body, which is allowed only if model lists obstacles");
  }
  if (effects.self_collision) {
    list.refuseBecause("has a body, which is not allowed if model lists self_collision");
  }
  if (file.has("state")) {
    file.at("state").refuseBecause(
        "is not allowed with a body among the obstacles: states have the cloth alone");
  }
  if (cloth::knowsBodies(method)) return;
  file.at("integrator")
      .refuse(
          "is not allowed with a body among the obstacles: backward_euler and the explicit "
          "ones are");
}

double readPenalty(const YamlValue& file, const cloth::ModelledEffects& effects,
                   cloth::IntegrationMethod method) {
  const YamlValue value = file.at("penalty");
  if (!effects.contacts || cloth::isImplicit(method)) {
    value.refuseBecause(
        "is allowed only with an explicit integrator, and if model lists obstacles");
  }
  const double stiffness = value.number();
  if (!(stiffness > 0.0)) value.refuse("must be > 0 N/m");
  return stiffness;
}

}  // namespace haptex::scene
