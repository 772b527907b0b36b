// What changes the fabrics, single properties or the sheet of ClothNode's cloth while it runs.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>

#include "haptex/base/require.h"
#include "haptex/material/fabric_file.h"
#include "haptex/nodes/cloth_simulation/cloth_node.h"
#include "haptex/nodes/common/cloth_messages.h"
#include "haptex/nodes/common/config_files.h"
#include "haptex/nodes/common/service_answer.h"

namespace haptex::nodes {
namespace {

using base::refuse;
using haptex::ClothConfig;
using Lock = std::lock_guard<boost::recursive_mutex>;

struct Property {
  const char* name;
  double ClothConfig::*value;
  bool of_air = false;
};

constexpr std::array<Property, 14> kProperties = {
    {{"weft", &ClothConfig::weft},
     {"warp", &ClothConfig::warp},
     {"shear", &ClothConfig::shear},
     {"bending", &ClothConfig::bending},
     {"density", &ClothConfig::density},
     {"gravity_x", &ClothConfig::gravity_x},
     {"gravity_y", &ClothConfig::gravity_y},
     {"gravity_z", &ClothConfig::gravity_z},
     {"wind_x", &ClothConfig::wind_x, true},
     {"wind_y", &ClothConfig::wind_y, true},
     {"wind_z", &ClothConfig::wind_z, true},
     {"air_normal", &ClothConfig::air_normal, true},
     {"air_tangential", &ClothConfig::air_tangential, true},
     {"air_lift", &ClothConfig::air_lift, true}}};

/// @throws std::invalid_argument naming the property, its value and what is allowed
void requireAllowed(const ClothConfig& properties, bool has_air) {
  for (const Property& property : kProperties) {
    const double value = properties.*property.value;
    const double least = ClothConfig::__getMin__().*property.value;
    const double most = ClothConfig::__getMax__().*property.value;
    if (!(value >= least && value <= most)) {
      refuse(property.name, " = ", value, ": allowed are ", least, " to ", most);
    }
    if (property.of_air && !has_air && value != 0.0) {
      refuse(property.name, " = ", value, ": the scene models no air: allowed is 0");
    }
  }
}

material::FabricFactors factorsOf(const ClothConfig& properties) {
  return {properties.weft, properties.warp, properties.shear, properties.bending,
          properties.density};
}

ClothConfig propertiesOf(const cloth::ModelledEffects& effects) {
  ClothConfig properties = ClothConfig::__getDefault__();
  properties.gravity_x = effects.gravity.x();
  properties.gravity_y = effects.gravity.y();
  properties.gravity_z = effects.gravity.z();
  if (!effects.air) return properties;
  properties.wind_x = effects.air->wind.mean.x();
  properties.wind_y = effects.air->wind.mean.y();
  properties.wind_z = effects.air->wind.mean.z();
  properties.air_normal = effects.air->coefficients.normal;
  properties.air_tangential = effects.air->coefficients.tangential;
  properties.air_lift = effects.air->coefficients.lift;
  return properties;
}

Eigen::Vector3d gravityOf(const ClothConfig& properties) {
  return {properties.gravity_x, properties.gravity_y, properties.gravity_z};
}

/// @param air that of the scene, whose gusts stay
std::optional<cloth::Air> airOf(const ClothConfig& properties, std::optional<cloth::Air> air) {
  if (!air) return air;
  air->wind.mean = {properties.wind_x, properties.wind_y, properties.wind_z};
  air->coefficients.normal = properties.air_normal;
  air->coefficients.tangential = properties.air_tangential;
  air->coefficients.lift = properties.air_lift;
  return air;
}

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
      refuse("names has '", name, "' twice: allowed is each once");
    }
    const auto property = std::find_if(kProperties.begin(), kProperties.end(),
                                       [&](const Property& it) { return it.name == name; });
    if (property == kProperties.end()) {
      std::string allowed;
      for (const Property& it : kProperties) allowed += std::string(" ") + it.name;
      refuse("names[", i, "] = '", name, "' is no property: allowed are", allowed);
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
    refuse("diagonals is '", request.diagonals, "': allowed are one_way and alternating");
  }
  return change;
}

}  // namespace

/// By dynamic_reconfigure. What a node before has left on the parameter server does not count.
void ClothNode::offerProperties(const ros::NodeHandle& private_node,
                                const cloth::ModelledEffects& effects) {
  properties_ = propertiesOf(effects);
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
  const material::FabricFactors factors = factorsOf(properties);
  bool same = true;
  for (const Property& property : kProperties) {
    same = same && properties.*property.value == properties_.*property.value;
  }
  if (same) return;
  loop_.execute([&](simulation::SimulatedCloth& simulation) {
    const std::optional<cloth::Air>& air = simulation.cloth().effects().air;
    requireAllowed(properties, air.has_value());
    simulation.setMaterial(scaledBy(factors, fabrics_), gravityOf(properties),
                           airOf(properties, air));
    factors_ = factors;
    publishMesh(simulation.cloth());
    publishQuality(simulation);
  });
  properties_ = properties;
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
    std::string message = "the fabric is " + fabric.name;
    loop_.execute([&](simulation::SimulatedCloth& simulation) {
      simulation.setFabric(material::scaledBy(factors_, fabric));
      publishMesh(simulation.cloth());
      publishQuality(simulation);
      const std::vector<material::Fabric>& fabrics = simulation.cloth().fabrics();
      for (std::size_t f = 1; f < fabrics.size(); ++f) {
        message += (f == 1 ? "; regions stay of " : ", ") + fabrics[f].name;
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
    ++mesh_;
    particle_count_ = particles;
    triangle_count_ = triangles;
    force_input_.sources().clearFor(particles);
    if (contact_input_) contact_input_->setMesh(mesh_, triangles);
    if (quality_) quality_->setScene(scene);
    state_stamp_ = ros::Time::now();
    stamped_step_ = simulation.steps();
    filled_step_ = simulation.computedSteps();
    fillStateMessage(simulation, state_stamp_, forces_, state_message_);
    state_message_.mesh = mesh_;
    publishMesh(simulation.cloth());
    publishQuality(simulation);
  });
}

}  // namespace haptex::nodes
