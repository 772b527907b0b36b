#include "haptex/scene/usual_elasticity.h"

namespace haptex::scene {

cloth::Elasticity usualElasticity(const cloth::ModelledEffects& effects) {
  const bool needs_triangles = effects.contraction || effects.membrane_hysteresis;
  return effects.bending && !needs_triangles ? cloth::Elasticity::kBilinear
                                             : cloth::Elasticity::kGreenLagrange;
}

}  // namespace haptex::scene
