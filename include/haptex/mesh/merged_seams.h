// The seams of a mesh whose panels are merged, found by its rest coordinates.
#pragma once

#include "haptex/mesh/mesh.h"

namespace haptex::mesh {

/// Adds a hinge, flat at rest, for every edge of two triangles that is a seam: they are of
/// different panels, or the panel has an end of the edge at two places, as along a dart. So a mesh
/// that was written to a file gets back what merge() gave it, but for angles at rest. If more than
/// two triangles share the edge, every further one has a hinge with the first.
/// @param mesh sound
void addHingesOfMergedSeams(ClothMesh& mesh);

}  // namespace haptex::mesh
