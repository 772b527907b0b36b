#include "haptex/garment/garment_mesh.h"

#include <algorithm>

#include "haptex/base/require.h"
#include "haptex/garment/triangulation/panel_mesh.h"
#include "haptex/garment/triangulation/seam_divisions.h"

namespace haptex::garment {
namespace {

/// The number of a name, which is added if it is new.
int indexOf(const std::string& name, std::vector<std::string>& names) {
  const auto at = std::find(names.begin(), names.end(), name) - names.begin();
  if (at == static_cast<std::ptrdiff_t>(names.size())) names.push_back(name);
  return static_cast<int>(at);
}

struct SewnSide {
  std::vector<int> particles;
  std::vector<double> shares;  // of the side's length
};

/// @param first number of the panel's first particle in the garment
SewnSide sewnSide(const Pattern& pattern, const SeamSide& side, const PanelMesh& panel, int first) {
  SewnSide sewn;
  const std::vector<int> edges = sewnEdges(pattern, side);
  const std::vector<double> passed = passedLengths(pattern, side);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const EdgeParticles& edge = panel.edges[side.outline][edges[i]];
    const auto count = static_cast<std::ptrdiff_t>(edge.particles.size());
    for (std::ptrdiff_t k = i == 0 ? 0 : 1; k < count; ++k) {
      const std::ptrdiff_t at = side.reversed ? count - 1 - k : k;
      const double along =
          side.reversed ? edge.lengths.back() - edge.lengths[at] : edge.lengths[at];
      sewn.particles.push_back(first + edge.particles[at]);
      sewn.shares.push_back((passed[i] + along) / passed.back());
    }
  }
  sewn.shares.front() = 0.0;
  sewn.shares.back() = 1.0;
  return sewn;
}

}  // namespace

GarmentMesh makeGarmentMesh(const Pattern& pattern, double edge_length) {
  for (const Panel& panel : pattern.panels) {
    const auto* on_carrier = std::get_if<OnCarrier>(&panel.placement);
    if (on_carrier == nullptr) continue;
    base::refuse("panel '", panel.name, "' is to be laid on the carrier '", on_carrier->carrier,
                 "': allowed are panels that are placed by position and rpy");
  }
  const double tolerance = kCurveTolerance * edge_length;
  const SeamDivisions divisions = divideSeams(pattern, edge_length, tolerance);
  std::vector<PanelMesh> panels;
  std::vector<int> first;  // particle, of every panel
  int particles = 0;
  for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
    panels.push_back(triangulate(pattern.panels[p], edge_length, tolerance, Interior::kEven,
                                 divisions.panels[p]));
    first.push_back(particles);
    particles += static_cast<int>(panels.back().mesh.rest_coordinates.size());
  }
  GarmentMesh garment;
  garment.mesh = joined(panels);
  for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
    garment.mesh.panels[p].fabric = indexOf(pattern.panels[p].fabric, garment.fabrics);
    garment.panel_names.push_back(pattern.panels[p].name);
  }
  for (std::size_t s = 0; s < pattern.seams.size(); ++s) {
    const auto side_of = [&](int i) {
      const SeamSide& side = pattern.seams[s].sides[i];
      return sewnSide(pattern, side, panels[side.panel], first[side.panel]);
    };
    SewnSide a = side_of(0), b = side_of(1);
    for (double& share : b.shares) share = divisions.seams[s].onFirst(share);
    garment.seams.push_back(
        {std::move(a.particles), std::move(b.particles), std::move(a.shares), std::move(b.shares)});
  }
  return garment;
}

}  // namespace haptex::garment
