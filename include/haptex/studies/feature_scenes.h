// The same sheet with one thing after the other listed in its scene, to see what each costs.
#pragma once

#include <string>
#include <vector>

#include "haptex/cloth/forces/point_loads.h"
#include "haptex/material/fabric.h"
#include "haptex/scene/scene.h"
#include "haptex/simulation/step_cost.h"

namespace haptex::studies {

/// A scene with what it needs to be stepped.
struct FeatureScene {
  scene::Scene scene;
  material::Fabric fabric;
  std::vector<cloth::PointLoad> loads;

  simulation::SteppedScene stepped() const;
};

/// Something that a scene may list.
struct Feature {
  std::string name;
  /// Adds everything that fabric and scene can say about it, but does not list it.
  void (*describe)(FeatureScene& scene);
  /// Lists what is described.
  void (*list)(FeatureScene& scene);
};

/// A sheet of 0.2 m that hangs from its upper edge, backward Euler with two solves of 12.5 ms.
/// Nothing is listed, and the fabric has nothing but its density and its elastic curves.
/// @param fabric whose density and curves these are @param cells along weft and warp
FeatureScene bareScene(const material::Fabric& fabric, int cells);

/// All that cost something in a step, each in the cases that differ.
const std::vector<Feature>& features();

}  // namespace haptex::studies
