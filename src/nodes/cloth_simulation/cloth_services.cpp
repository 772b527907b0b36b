// The services of ClothNode. Each checks its request, changes the simulation between two steps, and
// answers what was done or why nothing was.
#include <algorithm>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>

#include "haptex/nodes/cloth_simulation/cloth_node.h"
#include "haptex/nodes/common/cloth_messages.h"
#include "haptex/nodes/common/service_answer.h"
#include "haptex/nodes/wire/checked_topics.h"
#include "haptex/nodes/wire/frame_names.h"
#include "haptex/scene/cloth_state_file.h"
#include "haptex/simulation/particle_requests.h"

namespace haptex::nodes {
namespace {

constexpr std::uint32_t kMaxSteps = 100000;

std::string counted(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

std::string excludedOf(const simulation::SimulatedCloth& simulation) {
  const std::vector<char>& excluded = simulation.excluded();
  const std::size_t included =
      static_cast<std::size_t>(std::count(excluded.begin(), excluded.end(), 0));
  return counted(excluded.size() - included, "particle") + " of " +
         std::to_string(simulation.cloth().particleCount()) + " excluded";
}

std::string openOf(const simulation::SimulatedCloth& simulation) {
  const std::size_t count = simulation.cloth().fasteners()->all().size();
  std::size_t open = 0;
  for (std::size_t f = 0; f < count; ++f) open += simulation.isFastened(f) ? 0 : 1;
  return counted(open, "fastener") + " of " + std::to_string(count) + " open";
}

}  // namespace

void ClothNode::advertiseServices() {
  services_ = {node_.advertiseService("cloth/reset", &ClothNode::reset, this),
               node_.advertiseService("cloth/pause", &ClothNode::pause, this),
               node_.advertiseService("cloth/step", &ClothNode::step, this),
               node_.advertiseService("cloth/set_fabric", &ClothNode::setFabric, this),
               node_.advertiseService("cloth/set_sheet", &ClothNode::setSheet, this),
               advertiseChecked(node_, "cloth/set_properties", &ClothNode::setProperties, this),
               advertiseChecked(node_, "cloth/attach", &ClothNode::attach, this),
               advertiseChecked(node_, "cloth/move", &ClothNode::move, this),
               advertiseChecked(node_, "cloth/release", &ClothNode::release, this),
               advertiseChecked(node_, "cloth/fasten", &ClothNode::fasten, this),
               advertiseChecked(node_, "cloth/unfasten", &ClothNode::unfasten, this),
               advertiseChecked(node_, "cloth/exclude", &ClothNode::exclude, this),
               advertiseChecked(node_, "cloth/include", &ClothNode::include, this),
               advertiseChecked(node_, "cloth/get_jacobian", &ClothNode::getJacobian, this),
               advertiseChecked(node_, "cloth/set_state", &ClothNode::setState, this),
               node_.advertiseService("cloth/save_state", &ClothNode::saveState, this),
               node_.advertiseService("cloth/set_quality", &ClothNode::setQuality, this),
               node_.advertiseService("cloth/query_budget", &ClothNode::queryBudget, this)};
}

bool ClothNode::reset(std_srvs::Trigger::Request& /*request*/,
                      std_srvs::Trigger::Response& response) {
  return answer("reset", response, [&] {
    loop_.execute([this](simulation::SimulatedCloth& simulation) {
      force_input_.sources().clear();
      if (contact_input_) contact_input_->loads().clear();
      simulation.reset();
    });
    return std::string("positions, velocities, attachments and time are those of the start");
  });
}

bool ClothNode::pause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response) {
  return answer("pause", response, [&] {
    loop_.setPaused(request.data);
    return std::string(request.data ? "paused" : "running");
  });
}

bool ClothNode::step(StepCloth::Request& request, StepCloth::Response& response) {
  return answer("step", response, [&] {
    if (request.steps < 1 || request.steps > kMaxSteps) {
      throw std::invalid_argument("steps = " + std::to_string(request.steps) +
                                  ": allowed are 1 to " + std::to_string(kMaxSteps));
    }
    std::optional<double> time_step;
    if (request.time_step != 0.0) time_step = request.time_step;
    const simulation::StepsRun taken = loop_.runSteps(request.steps, time_step);
    const std::string message = "took " + counted(taken.steps, "step");
    if (taken.end == simulation::StepsRun::End::kRejected) {
      throw std::runtime_error(message + "; the next was not finite and was rejected");
    }
    if (taken.end == simulation::StepsRun::End::kInterrupted) {
      throw std::runtime_error(message + "; then the simulation was resumed or ended");
    }
    return message;
  });
}

bool ClothNode::attach(AttachParticles::Request& request, AttachParticles::Response& response) {
  return answer("attach", response, [&] {
    const std::string attached = "attached " + counted(request.particles.size(), "particle");
    if (request.header.frame_id != fixedFrame()) {
      const std::string frame = carryingFrame(request.header.frame_id);
      if (!request.positions.empty()) {
        throw std::invalid_argument("positions has " + counted(request.positions.size(), "item") +
                                    ": with a frame that carries the particles allowed are none");
      }
      const Eigen::Isometry3d pose = frames_.poseOf(request.header);
      loop_.execute([&](simulation::SimulatedCloth& simulation) {
        simulation.attach(request.particles, frame, pose);
      });
      return attached + " to " + request.header.frame_id;
    }
    loop_.execute([&](simulation::SimulatedCloth& simulation) {
      if (request.positions.empty()) {
        simulation.attach(request.particles);
      } else {
        simulation.attach(request.particles, fromMessage(request.positions));
      }
    });
    return attached;
  });
}

bool ClothNode::move(MoveParticles::Request& request, MoveParticles::Response& response) {
  return answer("move", response, [&] {
    requireFixedFrame(request.header);
    const Eigen::Vector3d displacement(request.displacement.x, request.displacement.y,
                                       request.displacement.z);
    loop_.execute([&](simulation::SimulatedCloth& simulation) {
      simulation.move(request.particles, displacement, request.duration);
    });
    return "moving " + counted(request.particles.size(), "particle");
  });
}

bool ClothNode::release(ReleaseParticles::Request& request, ReleaseParticles::Response& response) {
  return answer("release", response, [&] {
    loop_.execute(
        [&](simulation::SimulatedCloth& simulation) { simulation.release(request.particles); });
    return "released " + counted(request.particles.size(), "particle");
  });
}

bool ClothNode::fasten(SelectFasteners::Request& request, SelectFasteners::Response& response) {
  return changeFasteners("fasten", &simulation::SimulatedCloth::fasten, request, response);
}

bool ClothNode::unfasten(SelectFasteners::Request& request, SelectFasteners::Response& response) {
  return changeFasteners("unfasten", &simulation::SimulatedCloth::unfasten, request, response);
}

bool ClothNode::changeFasteners(const char* service, ChangeFasteners change,
                                const SelectFasteners::Request& request,
                                SelectFasteners::Response& response) {
  return answer(service, response, [&] {
    std::string left;
    loop_.execute([&](simulation::SimulatedCloth& simulation) {
      (simulation.*change)(request.names);
      left = openOf(simulation);
    });
    return left;
  });
}

bool ClothNode::exclude(SelectParticles::Request& request, SelectParticles::Response& response) {
  return answer("exclude", response, [&] {
    std::string left;
    loop_.execute([&](simulation::SimulatedCloth& simulation) {
      simulation.exclude(simulation::selectedParticles(simulation.cloth().mesh(), request.particles,
                                                       request.weft, request.warp));
      left = excludedOf(simulation);
    });
    return left;
  });
}

bool ClothNode::include(SelectParticles::Request& request, SelectParticles::Response& response) {
  return answer("include", response, [&] {
    std::string left;
    loop_.execute([&](simulation::SimulatedCloth& simulation) {
      simulation.include(simulation::selectedParticles(simulation.cloth().mesh(), request.particles,
                                                       request.weft, request.warp));
      left = excludedOf(simulation);
    });
    return left;
  });
}

bool ClothNode::getJacobian(GetJacobian::Request& request, GetJacobian::Response& response) {
  return answer("get_jacobian", response, [&] {
    loop_.execute([&](simulation::SimulatedCloth& simulation) {
      fillJacobianResponse(simulation.jacobian(request.particles), response);
      response.header.stamp = state_stamp_;
      response.header.frame_id = fixedFrame();
      response.simulated_time = simulation.state().time;
    });
    return counted(response.rows.size(), "block");
  });
}

bool ClothNode::setState(SetState::Request& request, SetState::Response& response) {
  return answer("set_state", response, [&] {
    requireFixedFrame(request.header);
    loop_.execute([&](simulation::SimulatedCloth& simulation) {
      simulation.setState(request.particles, fromMessage(request.positions),
                          fromMessage(request.velocities));
      state_stamp_ = ros::Time::now();  // another state of the same step
    });
    return "set " +
           counted(std::max(request.positions.size(), request.velocities.size()), "particle");
  });
}

bool ClothNode::saveState(SaveState::Request& request, SaveState::Response& response) {
  return answer("save_state", response, [&] {
    cloth::ClothState state;
    loop_.execute([&](simulation::SimulatedCloth& simulation) { state = simulation.state(); });
    scene::saveState(request.path, state);  // here: the loop does not wait for files
    std::ostringstream message;
    message << counted(state.positions.size(), "particle") << " at " << state.time << " s in "
            << request.path;
    return message.str();
  });
}

bool ClothNode::setQuality(SetQuality::Request& request, SetQuality::Response& response) {
  return answer("set_quality", response, [&] {
    requireQuality();
    std::string message;
    loop_.execute([&](simulation::SimulatedCloth& simulation) {
      message = quality_->set(simulation, request.quality, 1e-3 * request.budget_ms);
      publishQuality(simulation);
    });
    return message;
  });
}

/// @throws std::invalid_argument
void ClothNode::requireQuality() const {
  if (quality_) return;
  throw std::invalid_argument(
      "the node runs by the scene's own settings: start it with ~quality "
      "or ~budget_ms, so that it measures what the qualities take");
}

bool ClothNode::queryBudget(QueryBudget::Request& request, QueryBudget::Response& response) {
  return answer("query_budget", response, [&] {
    requireQuality();
    std::string message;
    loop_.execute([&](simulation::SimulatedCloth& simulation) {
      message = quality_->query(simulation, 1e-3 * request.budget_ms, response);
    });
    return message;
  });
}

}  // namespace haptex::nodes
