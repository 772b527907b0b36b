#include "haptex/nodes/simulated_cloth.h"

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

namespace haptex::nodes {
namespace {

template <typename... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  std::ostringstream message;
  (message << ... << parts);
  throw std::invalid_argument(message.str());
}

void requirePlace(const std::string& name, const Eigen::Vector3d& place) {
  if (!place.allFinite() || place.cwiseAbs().maxCoeff() > kLargestCoordinate) {
    refuse(name, " = (", place.x(), ", ", place.y(), ", ", place.z(),
           ") m: allowed are finite coordinates from ", -kLargestCoordinate, " to ",
           kLargestCoordinate, " m");
  }
}

std::string element(const std::string& array, std::size_t index) {
  return array + "[" + std::to_string(index) + "]";
}

}  // namespace

SimulatedCloth::SimulatedCloth(cloth::Scene scene, material::Fabric fabric)
    : cloth_(std::move(scene.mesh), std::move(fabric), scene.effects),
      state_(cloth_.initialState()),
      step_settings_(scene.step),
      integrator_(cloth_, step_settings_),
      initially_attached_(std::move(scene.attached_particles)),
      time_step_(scene.time_step) {
  attachInitially();
}

bool SimulatedCloth::step() {
  report_ = integrator_.step(cloth_, state_, time_step_);
  last_step_rejected_ = !report_.accepted;
  if (report_.accepted) ++steps_;
  return report_.accepted;
}

void SimulatedCloth::reset() {
  cloth_.releaseAll();
  cloth_.setPointLoads({});
  attachInitially();
  state_ = cloth_.initialState();
  report_ = cloth::StepReport{};
  last_step_rejected_ = false;
  steps_ = 0;
}

void SimulatedCloth::setFabric(material::Fabric fabric) {
  cloth_.setFabric(std::move(fabric));
  if (cloth_.bending()) integrator_ = cloth::Integrator(cloth_, step_settings_);
}

void SimulatedCloth::setPointLoads(const std::vector<cloth::PointLoad>& loads) {
  cloth_.setPointLoads(loads);
}

void SimulatedCloth::attach(const std::vector<std::uint32_t>& particles) {
  for (const int particle : requireParticles(particles)) {
    cloth_.attach(particle, {state_.positions[particle], Eigen::Vector3d::Zero(), state_.time, 0});
  }
}

void SimulatedCloth::attach(const std::vector<std::uint32_t>& particles,
                            const std::vector<Eigen::Vector3d>& places) {
  const std::vector<int> indices = requireParticles(particles);
  if (places.size() != indices.size()) {
    refuse("positions has ", places.size(), " elements and particles ", indices.size(),
           ": allowed is one position for each particle, or none to attach them where they are");
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    requirePlace(element("positions", i), places[i]);
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    cloth_.attach(indices[i], {places[i], Eigen::Vector3d::Zero(), state_.time, 0});
  }
}

void SimulatedCloth::move(const std::vector<std::uint32_t>& particles,
                          const Eigen::Vector3d& displacement, double duration) {
  const std::vector<int> indices = requireAttached(particles);
  if (!displacement.allFinite()) {
    refuse("displacement = (", displacement.x(), ", ", displacement.y(), ", ", displacement.z(),
           ") m: allowed are finite numbers");
  }
  if (!std::isfinite(duration) || duration < 0) {
    refuse("duration = ", duration, " s: allowed are finite numbers >= 0");
  }
  std::vector<Eigen::Vector3d> starts;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    starts.push_back(cloth_.attachments()[indices[i]]->position(state_.time));
    requirePlace("the end of the path of " + element("particles", i), starts[i] + displacement);
  }
  for (std::size_t i = 0; i < indices.size(); ++i) {
    cloth_.attach(indices[i], {starts[i], displacement, state_.time, duration});
  }
}

void SimulatedCloth::release(const std::vector<std::uint32_t>& particles) {
  for (const int particle : requireAttached(particles)) cloth_.release(particle);
}

std::vector<cloth::JacobianBlock> SimulatedCloth::jacobian(
    const std::vector<std::uint32_t>& particles) const {
  return cloth_.jacobian(state_, requireParticles(particles));
}

std::vector<int> SimulatedCloth::requireParticles(
    const std::vector<std::uint32_t>& particles) const {
  if (particles.empty()) refuse("particles is empty: allowed is at least one particle");
  std::vector<bool> named(cloth_.particleCount(), false);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const std::uint32_t particle = particles[i];
    if (particle >= named.size()) {
      refuse(element("particles", i), " = ", particle, " does not exist: allowed are 0 to ",
             named.size() - 1);
    }
    if (named[particle]) {
      refuse(element("particles", i), " = ", particle,
             " is named twice: allowed is each particle once");
    }
    named[particle] = true;
  }
  return {particles.begin(), particles.end()};
}

std::vector<int> SimulatedCloth::requireAttached(
    const std::vector<std::uint32_t>& particles) const {
  const std::vector<int> indices = requireParticles(particles);
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (!cloth_.isAttached(indices[i])) {
      refuse(element("particles", i), " = ", indices[i],
             " is not attached: allowed are attached particles");
    }
  }
  return indices;
}

void SimulatedCloth::attachInitially() {
  for (const int particle : initially_attached_) {
    cloth_.attach(particle,
                  {cloth_.mesh().initial_positions[particle], Eigen::Vector3d::Zero(), 0, 0});
  }
}

}  // namespace haptex::nodes
