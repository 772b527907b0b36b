// From flat panels to a garment at rest on a body.
#pragma once

#include <vector>

#include "haptex/garment/garment_mesh.h"
#include "haptex/material/fabric.h"
#include "haptex/mesh/mesh.h"
#include "haptex/mesh/obstacle.h"

namespace haptex::dressing {

/// How a garment is sewn and comes to rest. The motion is overdamped: every particle moves at
/// F / (m damping), so the garment goes from equilibrium to equilibrium and does not swing.
struct DrapeSettings {
  double time_step = 0.02;  ///< s, while seams close; the shortest afterwards
  double damping = 10.0;    ///< 1/s: free fall is at 9.81 / damping m/s
  // While seams close:
  double closing_speed = 0.5;  ///< m/s, at most, of the sides of a seam towards each other
  double tension = 20.0;       ///< N/m, at most, by which they are pulled together
  double lift = 1.0;           ///< m/s^2 upwards, as hands hold a garment up; may be 0
  /// m: fabric is at least so thick then, but half of the shortest altitude of its triangles at
  /// most. It keeps a distance from the body and from itself that sewing can do without.
  double thickness = 4e-3;
  double sewn_gap = 8e-3;  ///< m, of particles from the middle of their seam, that sewing closes
  /// s: after so long without a gap that is 2 % less, where what is sewn would intersect, panels
  /// get thinner, or all begins anew in another way (drape()). In the end such a state that would
  /// intersect itself is sewn for a trial, and pulled apart (cloth::Untangling) for up to twice
  /// that time. If that fails seams go on closing, up to the next trial.
  double patience = 0.2;
  double most_closing_time = 40.0;  ///< s, of each way
  // From then on:
  int halvings = 0;            ///< how often edges are halved once the garment is sewn, 0 to 8
  double halved_speed = 5e-3;  ///< m/s: the fastest particle is slower than that when they are
  double farthest = 0.01;      ///< m: steps are so long that no particle goes farther, about, but
  double longest_step = 0.5;   ///< s, at most, > time_step
  // Rest:
  double rest_speed = 2e-3;  ///< m/s: the fastest particle has been slower than that for
  double rest_time = 0.4;    ///< s, and in two steps at least
  double most_time = 60.0;   ///< s, for coming to rest with edges as they are
  int threads = 1;           ///< that share the work of a step
};

/// For a garment that has the machine for itself: as many as processors, kMaxThreads at most.
int allThreads();

/// Edges with which a garment is sewn, and how often they are halved then, to get those asked for.
struct CoarseStart {
  double edge_length;  // m
  int halvings;
};
/// As few triangles as a garment can do with are sewn: edges of 23 to 45 mm, if finer ones are
/// asked for.
/// @param edge_length m, > 0, that is asked for
CoarseStart coarseStart(double edge_length);

/// What came out, and what it took.
struct DrapeOutcome {
  /// Sewn into one mesh (mesh::merge()), with the panels of the garment. Initial positions are
  /// those at the end.
  mesh::ClothMesh mesh;
  double closed_gap = 0.0;     ///< m, the largest that sewing closed at once
  double closing_time = 0.0;   ///< s, what began anew included
  double settling_time = 0.0;  ///< s
  double fastest = 0.0;        ///< m/s, at the end
  int steps = 0;
  double wall_seconds = 0.0;    ///< by the clock
  int intersecting_states = 0;  ///< that intersected themselves, of all after a step
  std::size_t with_itself = 0;  ///< pairs of triangles that intersect at the end
  std::size_t with_body = 0;    ///< likewise, of the garment and of the body
  bool at_rest = false;         ///< or most_time was spent

  bool isSound() const { return at_rest && with_itself == 0 && with_body == 0; }
};

/// Sews a garment on a body that stands still, and lets it come to rest under gravity.
///
/// 1. The sides of seams are pulled together without friction, and with a lift instead of weight.
///    Panels touch the body and each other and pass through neither. There are four ways, of which
///    the next begins anew where one does not lead to what can be sewn. The middle of a seam is
///    expected to go on as in the last step; or by half of that, which takes longer, but sides of
///    seams rarely come to lie over each other; or by a fifth, and panels get thinner where they
///    would intersect themselves; or the first one again.
/// 2. As soon as all are near, and what is sewn together there intersects neither itself nor the
///    body, or can be pulled apart, they become one mesh.
/// 3. That comes to rest with weight, thickness and friction as they are.
/// 4. Its edges are halved (garment::halved()) where it is, and it comes to rest again, as often as
///    settings say. So panels are sewn with few triangles, whatever is asked for in the end, and
///    what is finer starts near its equilibrium, and free of intersections.
/// @param fabrics those that the garment names, in its order
/// @param body closed surface, m, world frame
/// @throws std::invalid_argument if a number of the settings is not finite and > 0, the garment
///   names another number of fabrics, one lacks bending, compression or friction, a panel touches
///   the body at the start, or what cloth::Cloth and mesh::merge() say
/// @throws std::runtime_error if a seam does not close within most_closing_time, naming its panels
///   and what is in the way, or a step is not finite
DrapeOutcome drape(const garment::GarmentMesh& garment,
                   const std::vector<material::Fabric>& fabrics, const mesh::ObstacleMesh& body,
                   const DrapeSettings& settings);

}  // namespace haptex::dressing
