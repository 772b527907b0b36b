// Cloth that folds, heaps, twists and pulls tight, and does not pass through itself.
#pragma once

#include <vector>

#include "haptex/material/fabric.h"
#include "haptex/mesh/mesh.h"
#include "haptex/oracles/scenes/self_colliding_cloth.h"

namespace haptex::oracles {

/// Sheets of their own as one mesh. Their rest coordinates lie beside each other.
/// @param fabrics of how many there are: sheet i is of fabric i modulo that
mesh::ClothMesh asOneMesh(const std::vector<mesh::ClothMesh>& sheets, int fabrics = 1);

/// - folded: a sheet that lies on a floor is folded twice,
/// - heaped: a sheet falls on its edge and heaps up,
/// - gathered: a curtain on rings is drawn to a tenth of its width,
/// - towel: falls over a pole, so that its ends swing together,
/// - ribbons: two that cross are wound around each other and pulled tight,
/// - twisted: the ends of a strip are turned against each other by a whole turn,
/// and those of obstacleSets().
/// @param cells along 100 mm, > 0
std::vector<SelfCollidingCloth::Set> selfCollisionScenes(int cells);

/// Thickness (m) of the compression curve at a pressure (Pa).
double thicknessAt(const material::Compression& compression, double pressure);

/// Layers on a lowest one that is attached, after some steps of 12.5 ms.
struct LayerStack {
  double exact;   ///< m, sum of the half thicknesses that the compression curves give for what is
                  ///< above
  double height;  ///< m, mean height of the highest middle surface over the lowest
};
/// @param fabrics of the layers, in turn
/// @param layers > 1
LayerStack restingStack(const std::vector<material::Fabric>& fabrics, int layers, int steps);

}  // namespace haptex::oracles
