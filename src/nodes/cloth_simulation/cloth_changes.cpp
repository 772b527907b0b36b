// What changes the fabrics, single properties or the sheet of ClothNode's cloth while it runs.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>

#include "haptex/base/quoted.h"
#include "haptex/base/require.h"
#include "haptex/material/fabric_file.h"
#include "haptex/nodes/cloth_simulation/cloth_node.h"
#include "haptex/nodes/cloth_simulation/cloth_properties.h"
#include "haptex/nodes/common/config_files.h"
#include "haptex/nodes/common/service_answer.h"

namespace haptex::nodes {
namespace {

using base::refuse;
using haptex::ClothConfig;
using Lock = std::lock_guard<boost::recursive_mutex>;

std::vector<material::Fabric> scaledBy(const material::FabricFactors& factors,
                                       std::vector<material::Fabric> fabrics) {
  for (material::Fabric& fabric : fabrics) fabric = material::scaledBy(factors, std::move(fabric));
  return fabrics;
}

ClothConfig withChanges(const SetProperties::Request& request, ClothConfig properties) {
  if (request.names.empty()) refuse("names is empty: allowed is at least one");
  if (request.names.size() != request.values.size()) {
    refuse("values has ", request.values.size(), " elements: allowed are ", request.names.size(),
           ", one per name");
  }
  for (std::size_t i = 0; i < request.names.size(); ++i) {
    const std::string& name = request.names[i];
    if (std::count(request.names.begin(), request.names.end(), name) > 1) {
      refuse("names has ", base::quoted(name), " twice: allowed is each once");
    }
    const auto property = std::find_if(kProperties.begin(), kProperties.end(),
                                       [&](const Property& it) { return it.name == name; });
    if (property == kProperties.end()) {
      std::string allowed;
      for (const Property& it : kProperties) allowed += std::string(" ") + it.name;
      refuse("names[", i, "] = ", base::quoted(name), " is no property: allowed are", allowed);
    }
    properties.*property->value = request.values[i];
  }
  return properties;
}

/// Zeros and empty texts: as the scene says.
scene::SheetChange changeOf(const SetSheet::Request& request) {
  constexpr std::uint32_t kMostCells = 100000;  // of more triangles than a scene may have
  scene::SheetChange change;
  if (request.size[0] != 0.0 || request.size[1] != 0.0) {
    change.size = {request.size[0], request.size[1]};
  }
  if (request.cells[0] != 0 || request.cells[1] != 0) {
    for (const std::uint32_t cells : request.cells) {
      if (cells > kMostCells) refuse("cells = ", cells, ": allowed are 1 to ", kMostCells);
    }
    change.cells = {static_cast<int>(request.cells[0]), static_cast<int>(request.cells[1])};
  }
  if (request.diagonals == "one_way") {
    change.diagonals = mesh::Triangulation::kOneWay;
  } else if (request.diagonals == "alternating") {
    change.diagonals = mesh::Triangulation::kAlternating;
  } else if (!request.diagonals.empty()) {
    refuse("diagonals is ", base::quoted(request.diagonals),
           ": allowed are one_way and alternating");
  }
  return change;
}

}  // namespace

/// By dynamic_reconfigure. What a node before has left on the parameter server does not count.
void ClothNode::offerProperties(const ros::NodeHandle& private_node) {
  reconfigure_ =
      std::make_unique<dynamic_reconfigure::Server<ClothConfig>>(changing_, private_node);
  reconfigure_->setConfigDefault(properties_);
  reconfigure_->updateConfig(properties_);
  reconfigure_->setCallback([this](ClothConfig& wanted, std::uint32_t /*level*/) {
    try {
      apply(wanted);
    } catch (const std::exception& error) {
      ROS_ERROR("The properties of the cloth stay: %s", error.what());
      wanted = properties_;
    }
  });
}

/// @throws std::invalid_argument if one is not allowed; nothing has changed then
void ClothNode::apply(const ClothConfig& properties) {
  const bool same =
      std::all_of(kProperties.begin(), kProperties.end(), [&](const Property& property) {
        return properties.*property.value == properties_.*property.value;
      });
  if (same) return;
  loop_.execute([&](simulation::SimulatedCloth& simulation) {
    const std::optional<cloth::Air>& air = simulation.cloth().effects().air;
    requireAllowed(properties, air.has_value());
    simulation.setMaterial(scaledBy(factorsOf(properties), fabrics_), gravityOf(properties),
                           airOf(properties, air));
    properties_ = properties;
    publishMesh(simulation.cloth());
    publishQuality(simulation);
  });
}

bool ClothNode::setProperties(SetProperties::Request& request, SetProperties::Response& response) {
  return answer("set_properties", response, [&] {
    const Lock lock(changing_);
    apply(withChanges(request, properties_));
    reconfigure_->updateConfig(properties_);
    std::string message;
    for (std::size_t i = 0; i < request.names.size(); ++i) {
      message +=
          (i == 0 ? "" : ", ") + request.names[i] + " = " + base::shortNumber(request.values[i]);
    }
    return message;
  });
}

bool ClothNode::setFabric(SetFabric::Request& request, SetFabric::Response& response) {
  return answer("set_fabric", response, [&] {
    // Read here: the loop does not wait for files.
    material::Fabric fabric = material::loadFabric(findConfigFile("fabrics", request.fabric));
    const Lock lock(changing_);
    std::string message = "the fabric is " + base::shortened(fabric.name);
    loop_.execute([&](simulation::SimulatedCloth& simulation) {
      simulation.setFabric(material::scaledBy(factorsOf(properties_), fabric));
      publishMesh(simulation.cloth());
      publishQuality(simulation);
      const std::vector<material::Fabric>& fabrics = simulation.cloth().fabrics();
      for (std::size_t f = 1; f < fabrics.size(); ++f) {
        message += (f == 1 ? "; regions stay of " : ", ") + base::shortened(fabrics[f].name);
      }
    });
    fabrics_.front() = std::move(fabric);
    if (factorsOf(properties_) != material::FabricFactors()) {
      message += "; the factors of set_properties stay";
    }
    return message;
  });
}

bool ClothNode::setSheet(SetSheet::Request& request, SetSheet::Response& response) {
  return answer("set_sheet", response, [&] {
    const scene::SheetChange change = changeOf(request);
    const Lock lock(changing_);
    // Made here: the loop does not wait for it.
    scene::Scene scene = scene::loadScene(scene_path_, change);
    scene.effects.gravity = gravityOf(properties_);
    scene.effects.air = airOf(properties_, scene.effects.air);
    std::vector<material::Fabric> fabrics = scaledBy(factorsOf(properties_), fabrics_);
    exchange(quality_ ? quality_->simulate(scene, std::move(fabrics))
                      : simulation::SimulatedCloth(scene, std::move(fabrics)),
             scene);
    return "the sheet has " + std::to_string(particle_count_) + " particles and " +
           std::to_string(triangle_count_) + " triangles";
  });
}

/// Lets the loop go on with another cloth, which has another mesh.
void ClothNode::exchange(simulation::SimulatedCloth next, const scene::Scene& scene) {
  ClothMarkers markers(scene.mesh, strain_scale_, scene.obstacles, colour_by_);
  const std::size_t particles = scene.mesh.initial_positions.size();
  const std::size_t triangles = scene.mesh.triangles.size();
  loop_.execute([&](simulation::SimulatedCloth& simulation) {
    std::swap(simulation, next);  // the old one is destroyed by this thread
    std::swap(markers_, markers);
    state_message_.mesh = ++mesh_;
    particle_count_ = particles;
    triangle_count_ = triangles;
    force_input_.sources().clearFor(particles);
    if (contact_input_) contact_input_->setMesh(mesh_, triangles);
    if (quality_) quality_->setScene(scene);
    state_stamp_ = ros::Time::now();
    stamped_step_ = simulation.steps();
    filled_step_.reset();
    fasteners_.restart();
    publishMesh(simulation.cloth());
    publishQuality(simulation);
  });
}

}  // namespace haptex::nodes
