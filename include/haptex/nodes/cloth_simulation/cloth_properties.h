// The properties of a running cloth that dynamic_reconfigure and cloth/set_properties set
// (cfg/Cloth.cfg).
#pragma once

#include <haptex/ClothConfig.h>

#include <Eigen/Core>
#include <array>
#include <optional>

#include "haptex/cloth/forces/modelled_effects.h"
#include "haptex/material/fabric_factors.h"

namespace haptex::nodes {

/// A number of the configuration.
struct Property {
  const char* name;
  double haptex::ClothConfig::*value;
  bool of_air = false;  ///< nothing but 0 where the scene models no air
};

constexpr std::array<Property, 14> kProperties = {
    {{"weft", &haptex::ClothConfig::weft},
     {"warp", &haptex::ClothConfig::warp},
     {"shear", &haptex::ClothConfig::shear},
     {"bending", &haptex::ClothConfig::bending},
     {"density", &haptex::ClothConfig::density},
     {"gravity_x", &haptex::ClothConfig::gravity_x},
     {"gravity_y", &haptex::ClothConfig::gravity_y},
     {"gravity_z", &haptex::ClothConfig::gravity_z},
     {"wind_x", &haptex::ClothConfig::wind_x, true},
     {"wind_y", &haptex::ClothConfig::wind_y, true},
     {"wind_z", &haptex::ClothConfig::wind_z, true},
     {"air_normal", &haptex::ClothConfig::air_normal, true},
     {"air_tangential", &haptex::ClothConfig::air_tangential, true},
     {"air_lift", &haptex::ClothConfig::air_lift, true}}};

/// @throws std::invalid_argument naming the property, its value and what is allowed
void requireAllowed(const haptex::ClothConfig& properties, bool has_air);

/// Those of a scene, with all factors 1.
haptex::ClothConfig propertiesOf(const cloth::ModelledEffects& effects);

material::FabricFactors factorsOf(const haptex::ClothConfig& properties);
Eigen::Vector3d gravityOf(const haptex::ClothConfig& properties);  ///< m/s^2, world
/// @param air that of the scene, whose gusts stay
std::optional<cloth::Air> airOf(const haptex::ClothConfig& properties,
                                std::optional<cloth::Air> air);

}  // namespace haptex::nodes
