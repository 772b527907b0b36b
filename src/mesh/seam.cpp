#include "haptex/mesh/seam.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "haptex/base/require.h"
#include "haptex/mesh/seam_edges.h"
#include "haptex/mesh/ties.h"

namespace haptex::mesh {
namespace {

/// Adds ties one by one, and resolves what meets in a point.
class Sewing {
 public:
  explicit Sewing(ClothMesh& mesh) : mesh_(mesh), tie_of_(mesh.rest_coordinates.size(), -1) {
    for (std::size_t i = 0; i < mesh.ties.size(); ++i) {
      tie_of_[mesh.ties[i].particle] = static_cast<int>(i);
    }
  }

  /// Ties the finer edge, unless it lies on another one already.
  void sew(const SeamEdge& first, const SeamEdge& second) {
    const bool first_is_finer = first.particles.size() > second.particles.size();
    const SeamEdge& finer = first_is_finer ? first : second;
    const SeamEdge& coarser = first_is_finer ? second : first;
    const bool turn = liesBetween(finer) && !liesBetween(coarser);
    tieTo(turn ? coarser : finer, turn ? finer : coarser);
  }

 private:
  bool liesBetween(const SeamEdge& edge) const {
    return std::any_of(edge.particles.begin(), edge.particles.end(),
                       [&](int particle) { return !partner(particle); });
  }

  void tieTo(const SeamEdge& tied, const SeamEdge& edge) {
    for (std::size_t i = 0; i < tied.particles.size(); ++i) {
      const double place = tied.places[i];
      const auto next = std::upper_bound(edge.places.begin() + 1, edge.places.end() - 1, place);
      const auto at = next - edge.places.begin() - 1;
      const double from = edge.places[at], to = edge.places[at + 1];
      double share = (place - from) / (to - from);
      if (share < kSamePlace) share = 0.0;
      if (share > 1.0 - kSamePlace) share = 1.0;
      add({tied.particles[i], {edge.particles[at], edge.particles[at + 1]}, share});
    }
  }

  /// The one particle that a tied one, or a free one, coincides with; nothing if it lies between
  /// two.
  std::optional<int> partner(int particle) const {
    while (tie_of_[particle] >= 0) {
      const Tie& tie = mesh_.ties[tie_of_[particle]];
      if (tie.share != 0.0 && tie.share != 1.0) return std::nullopt;
      particle = tie.ends[tie.share == 0.0 ? 0 : 1];
    }
    return particle;
  }

  void add(const Tie& tie) {
    const std::optional<int> own = partner(tie.particle);
    const bool on_particle = tie.share == 0.0 || tie.share == 1.0;
    const int end = tie.ends[tie.share == 0.0 ? 0 : 1];
    const std::optional<int> target = on_particle ? partner(end) : std::nullopt;
    if (own && target && *own == *target) return;
    if (own) return put(*own, tie);
    if (!target) {
      base::refuse("particle ", tie.particle,
                   " would lie on two edges at once, one of them from particle ", tie.ends[0],
                   " to ", tie.ends[1], "; it can be sewn to one edge, and to particles of others");
    }
    Tie other = mesh_.ties[tie_of_[lastBetween(tie.particle)]];
    other.particle = *target;
    put(*target, other);
  }

  /// The particle between two others that a tied one coincides with.
  int lastBetween(int particle) const {
    while (true) {
      const Tie& tie = mesh_.ties[tie_of_[particle]];
      if (tie.share != 0.0 && tie.share != 1.0) return particle;
      particle = tie.ends[tie.share == 0.0 ? 0 : 1];
    }
  }

  void put(int particle, const Tie& tie) {
    tie_of_[particle] = static_cast<int>(mesh_.ties.size());
    mesh_.ties.push_back(tie);
    mesh_.ties.back().particle = particle;
  }

  ClothMesh& mesh_;
  std::vector<int> tie_of_;  // by particle, in mesh_.ties; -1: it is free
};

}  // namespace

void sew(ClothMesh& mesh, const std::vector<Seam>& seams) {
  ClothMesh sewn = mesh;
  Sewing sewing(sewn);
  const BorderTriangles triangles = borderTriangles(sewn);
  for (const Seam& seam : seams) {
    requireSeamAngle(seam.angle);
    const SeamEdge first = seamEdge(sewn, triangles, "first", seam.first, seam.first_places);
    const SeamEdge second = seamEdge(sewn, triangles, "second", seam.second, seam.second_places);
    sewing.sew(first, second);
    addSeamHinges(first, second, seam.angle, sewn);
  }
  resolveTies(sewn.ties, sewn.rest_coordinates.size());  // whether they contradict each other
  mesh = std::move(sewn);
}

}  // namespace haptex::mesh
