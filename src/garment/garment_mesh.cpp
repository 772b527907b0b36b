#include "haptex/garment/garment_mesh.h"

#include <algorithm>
#include <array>

#include "haptex/base/require.h"
#include "haptex/garment/placement/preposition.h"
#include "haptex/garment/triangulation/doubled_edges.h"
#include "haptex/garment/triangulation/panel_mesh.h"
#include "haptex/garment/triangulation/seam_divisions.h"

namespace haptex::garment {
namespace {

// Triangulations, each with the places that sides of seams got in the one before where panels are
// narrow.
constexpr int kMostTurns = 8;

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

/// Both sides of a seam, with places as shares of the first.
std::array<SewnSide, 2> sewnSides(const Pattern& pattern, std::size_t seam,
                                  const SeamDivisions& divisions,
                                  const std::vector<PanelMesh>& panels,
                                  const std::vector<int>& first) {
  const auto side_of = [&](int i) {
    const SeamSide& side = pattern.seams[seam].sides[i];
    return sewnSide(pattern, side, panels[side.panel], first[side.panel]);
  };
  std::array<SewnSide, 2> sides = {side_of(0), side_of(1)};
  for (double& share : sides[1].shares) share = divisions.seams[seam].onFirst(share);
  return sides;
}

/// Divides the sides of seams where the other one has a particle.
/// @return whether the panels have such places
std::vector<char> divideWhereTheOtherIs(const Pattern& pattern,
                                        const std::vector<PanelMesh>& panels,
                                        SeamDivisions& divisions) {
  std::vector<char> changed(panels.size(), 0);
  const std::vector<int> first(panels.size(), 0);
  for (std::size_t s = 0; s < pattern.seams.size(); ++s) {
    const std::array<SewnSide, 2> sides = sewnSides(pattern, s, divisions, panels, first);
    for (int i = 0; i < 2; ++i) {
      const SeamSide& side = pattern.seams[s].sides[i];
      for (const double share : sides[1 - i].shares) {
        const double own = i == 0 ? share : divisions.seams[s].onSecond(share);
        const bool added = divideAt(pattern, side, own, divisions.panels[side.panel]);
        if (added) changed[side.panel] = 1;
      }
    }
  }
  return changed;
}

/// Triangles of all panels; both sides of seams have particles in the same places.
std::vector<PanelMesh> triangulateAlike(const Pattern& pattern, double edge_length,
                                        SeamDivisions& divisions) {
  const double tolerance = kCurveTolerance * edge_length;
  divisions = divideSeams(pattern, edge_length, tolerance);
  std::vector<PanelMesh> panels(pattern.panels.size());
  std::vector<char> changed(panels.size(), 1);
  for (int turn = 0; turn < kMostTurns && std::count(changed.begin(), changed.end(), 1) > 0;
       ++turn) {
    for (std::size_t p = 0; p < panels.size(); ++p) {
      if (!changed[p]) continue;
      panels[p] = triangulate(pattern.panels[p], edge_length, tolerance, Interior::kEven,
                              divisions.panels[p]);
    }
    changed = divideWhereTheOtherIs(pattern, panels, divisions);
  }
  return panels;
}

std::vector<mesh::Seam> seamsOf(const Pattern& pattern, const SeamDivisions& divisions,
                                const std::vector<PanelMesh>& panels) {
  const std::vector<int> first = firstParticles(panels);
  std::vector<mesh::Seam> seams;
  for (std::size_t s = 0; s < pattern.seams.size(); ++s) {
    auto [a, b] = sewnSides(pattern, s, divisions, panels, first);
    seams.push_back(
        {std::move(a.particles), std::move(b.particles), std::move(a.shares), std::move(b.shares)});
  }
  return seams;
}

/// @param body on which panels are laid; null: none may be on a carrier
GarmentMesh make(const Pattern& pattern, double edge_length, const Body* body) {
  SeamDivisions divisions;
  std::vector<PanelMesh> panels = triangulateAlike(pattern, edge_length, divisions);
  splitDoubledEdges(seamsOf(pattern, divisions, panels), panels);
  if (body != nullptr) preposition(pattern, *body, panels);
  const std::vector<int> first = firstParticles(panels);
  GarmentMesh garment;
  garment.pattern = pattern;
  garment.mesh = joined(panels);
  for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
    garment.mesh.panels[p].fabric = indexOf(pattern.panels[p].fabric, garment.fabrics);
    garment.panel_names.push_back(pattern.panels[p].name);
    garment.edges.push_back(panels[p].edges);
    for (auto& outline : garment.edges.back()) {
      for (EdgeParticles& edge : outline) {
        for (int& particle : edge.particles) particle += first[p];
      }
    }
  }
  garment.seams = seamsOf(pattern, divisions, panels);
  return garment;
}

}  // namespace

GarmentMesh makeGarmentMesh(const Pattern& pattern, double edge_length) {
  for (const Panel& panel : pattern.panels) {
    const auto* on_carrier = std::get_if<OnCarrier>(&panel.placement);
    if (on_carrier == nullptr) continue;
    base::refuse("panel '", panel.name, "' is to be laid on the carrier '", on_carrier->carrier,
                 "': that takes a body with segments, allowed without one are panels that are "
                 "placed by position and rpy");
  }
  return make(pattern, edge_length, nullptr);
}

GarmentMesh makeGarmentMesh(const Pattern& pattern, double edge_length, const Body& body) {
  return make(pattern, edge_length, &body);
}

}  // namespace haptex::garment
