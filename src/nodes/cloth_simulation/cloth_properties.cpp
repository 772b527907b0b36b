#include "haptex/nodes/cloth_simulation/cloth_properties.h"

#include "haptex/base/require.h"

namespace haptex::nodes {

using haptex::ClothConfig;

void requireAllowed(const ClothConfig& properties, bool has_air) {
  for (const Property& property : kProperties) {
    const double value = properties.*property.value;
    const double least = ClothConfig::__getMin__().*property.value;
    const double most = ClothConfig::__getMax__().*property.value;
    if (!(value >= least && value <= most)) {
      base::refuse(property.name, " = ", value, ": allowed are ", least, " to ", most);
    }
    if (property.of_air && !has_air && value != 0.0) {
      base::refuse(property.name, " = ", value, ": the scene models no air: allowed is 0");
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

std::optional<cloth::Air> airOf(const ClothConfig& properties, std::optional<cloth::Air> air) {
  if (!air) return air;
  air->wind.mean = {properties.wind_x, properties.wind_y, properties.wind_z};
  air->coefficients.normal = properties.air_normal;
  air->coefficients.tangential = properties.air_tangential;
  air->coefficients.lift = properties.air_lift;
  return air;
}

}  // namespace haptex::nodes
