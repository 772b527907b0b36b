// What does the response by penalty cost that mass-spring cloths began with, beside exact
// constraints? Prints for the scene sphere_mass_spring in still air, over a second in which the
// ball rolls through the hanging lattice: processor time over simulated time, how deep particles
// get into the ball, how far the ball ends from where it does in short steps of the same response,
// and by how much the energy of ball and cloth together ever rises. Responses: penalty with
// Runge-Kutta, particles brought back with Runge-Kutta, and constraints in the implicit step.
#include <algorithm>
#include <cmath>
#include <string>
#include <variant>
#include <vector>

#include "haptex/contact/bodies/free_body.h"
#include "haptex/material/fabric_file.h"
#include "haptex/scene/scene.h"
#include "haptex/simulation/simulated_cloth.h"
#include "tab_lines.h"

namespace {

using namespace haptex;
using Eigen::Vector3d;

constexpr double kDuration = 1.0;  // s

struct Response {
  std::string name;
  cloth::IntegrationMethod method;
  bool penalty;
  std::vector<double> time_steps;  // s, the last is the reference
};

struct Outcome {
  double load = 0.0;   // processor time over simulated time
  double depth = 0.0;  // m
  double rise = 0.0;   // J
  bool blown_up = false;
  Vector3d ball = Vector3d::Zero();  // m, at the end
};

double energyOf(const simulation::SimulatedCloth& simulation) {
  double energy = simulation.cloth().kineticEnergy(simulation.state()) +
                  simulation.cloth().potentialEnergy(simulation.state());
  for (const contact::FreeBody& body : simulation.bodies()) {
    energy += body.kineticEnergy() -
              body.mass() * simulation.cloth().effects().gravity.dot(body.pose().translation());
  }
  return energy;
}

Outcome run(const Response& response, double time_step) {
  scene::Scene scene = scene::loadScene(HAPTEX_CONFIG_DIRECTORY "/scenes/sphere_mass_spring.yaml");
  scene.effects.air.reset();
  scene.step.method = response.method;
  scene.step.newton_iterations = 3;
  scene.time_step = time_step;
  if (!response.penalty) scene.penalty.reset();
  const auto ball =
      std::find_if(scene.obstacles.begin(), scene.obstacles.end(),
                   [](const mesh::Obstacle& obstacle) { return bool(obstacle.body); });
  const double radius = std::get<mesh::ObstacleSphere>(ball->shape).radius;
  const material::Fabric fabric = material::loadFabric(scene.fabric_path);
  simulation::SimulatedCloth simulation(scene, fabric);
  Outcome outcome;
  double least = energyOf(simulation), seconds = 0.0;
  while (simulation.state().time < kDuration - 0.5 * time_step) {
    const double begin = bench::processorSeconds();
    const bool accepted = simulation.step();
    seconds += bench::processorSeconds() - begin;
    const double energy = energyOf(simulation);
    if (!accepted || !(energy < 1.0)) {  // of millijoules
      outcome.blown_up = true;
      return outcome;
    }
    outcome.rise = std::max(outcome.rise, energy - least);
    least = std::min(least, energy);
    const Vector3d centre = simulation.bodies()[0].pose().translation();
    for (const Vector3d& place : simulation.state().positions) {
      outcome.depth = std::max(outcome.depth, radius - (place - centre).norm());
    }
  }
  outcome.load = seconds / kDuration;
  outcome.ball = simulation.bodies()[0].pose().translation();
  return outcome;
}

void print(const Response& response) {
  std::vector<Outcome> outcomes;
  for (const double time_step : response.time_steps) outcomes.push_back(run(response, time_step));
  for (std::size_t i = 0; i < outcomes.size(); ++i) {
    const std::string name = "sphere/" + response.name + "/" +
                             std::to_string(std::lround(1e6 * response.time_steps[i])) + "_us/";
    bench::printLine(name + "blown_up", outcomes[i].blown_up ? 1.0 : 0.0, "1");
    if (outcomes[i].blown_up) continue;
    bench::printLine(name + "load", outcomes[i].load, "1");
    bench::printLine(name + "depth", 1e3 * outcomes[i].depth, "mm");
    bench::printLine(name + "energy_rise", 1e6 * outcomes[i].rise, "uJ");
    if (i + 1 == outcomes.size()) continue;
    bench::printLine(name + "ball_off", 1e3 * (outcomes[i].ball - outcomes.back().ball).norm(),
                     "mm");
  }
}

}  // namespace

int main() {
  using cloth::IntegrationMethod;
  const std::vector<Response> responses = {
      {"penalty", IntegrationMethod::kRungeKutta4, true, {1e-3, 5e-4, 2.5e-4, 6.25e-5}},
      {"brought_back", IntegrationMethod::kRungeKutta4, false, {1e-3, 5e-4, 2.5e-4, 6.25e-5}},
      {"constraints", IntegrationMethod::kBackwardEuler, false, {1.25e-2, 5e-3, 1e-3, 2.5e-4}},
  };
  for (const Response& response : responses) print(response);
  return 0;
}
