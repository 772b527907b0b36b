#include "haptex/dressing/seam_pull.h"

#include <algorithm>
#include <map>

#include "haptex/base/disjoint_sets.h"
#include "haptex/mesh/seam_partners.h"

namespace haptex::dressing {
namespace {

using Eigen::Vector3d;

// Where a particle comes nearer by less than that part of the farthest way in a step, it is pulled
// harder from step to step, up to kMost times.
constexpr double kStuck = 0.1, kGrowth = 1.05, kMost = 20.0;

/// Half of the pieces of an edge beside each of its particles (m, at rest).
std::vector<double> lengthsAt(const mesh::ClothMesh& mesh, const std::vector<int>& particles) {
  std::vector<double> lengths(particles.size(), 0.0);
  for (std::size_t i = 1; i < particles.size(); ++i) {
    const double half =
        0.5 *
        (mesh.rest_coordinates[particles[i]] - mesh.rest_coordinates[particles[i - 1]]).norm();
    lengths[i - 1] += half;
    lengths[i] += half;
  }
  return lengths;
}

}  // namespace

SeamPull::SeamPull(const garment::GarmentMesh& garment, double tension) {
  const mesh::ClothMesh& mesh = garment.mesh;
  base::DisjointSets together(mesh.rest_coordinates.size());
  std::map<int, Member> members;
  for (std::size_t s = 0; s < garment.seams.size(); ++s) {
    const mesh::Seam& seam = garment.seams[s];
    for (const auto& [a, b] : mesh::partners(seam)) together.join(a, b);
    for (const std::vector<int>* side : {&seam.first, &seam.second}) {
      const std::vector<double> lengths = lengthsAt(mesh, *side);
      for (std::size_t i = 0; i < side->size(); ++i) {
        const int particle = (*side)[i];
        const Member fresh = {particle, -1, -1, 0, static_cast<int>(s)};
        members.emplace(particle, fresh).first->second.force += tension * lengths[i];
      }
    }
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const auto member = members.find(mesh.triangles[t][i]);
      if (member == members.end()) continue;
      member->second.triangle = static_cast<int>(t);
      member->second.corner = i;
    }
  }
  std::map<int, int> groups;
  for (auto& [particle, member] : members) {
    member.group =
        groups.emplace(together.root(particle), static_cast<int>(groups.size())).first->second;
    member.most = kMost * member.force;
    members_.push_back(member);
  }
  sizes_.assign(groups.size(), 0);
  for (const Member& member : members_) ++sizes_[member.group];
}

std::vector<Vector3d> SeamPull::middles(const std::vector<Vector3d>& positions) const {
  std::vector<Vector3d> middles(sizes_.size(), Vector3d::Zero());
  for (const Member& member : members_) {
    middles[member.group] += positions[member.particle] / sizes_[member.group];
  }
  return middles;
}

const std::vector<cloth::PointLoad>& SeamPull::loads(const std::vector<Vector3d>& positions,
                                                     double farthest, double onwards) {
  std::vector<Vector3d> targets = middles(positions);
  std::vector<Vector3d> before = targets;
  before.swap(middles_before_);
  for (std::size_t i = 0; i < before.size(); ++i) targets[i] += onwards * (targets[i] - before[i]);
  loads_.clear();
  for (Member& member : members_) {
    if (sizes_[member.group] == 1) continue;
    const Vector3d& place = positions[member.particle];
    Vector3d way = targets[member.group] - place;
    const double length = way.norm();
    const bool stuck = length > kStuck * farthest && length > member.length - kStuck * farthest;
    if (stuck) member.force = std::min(kGrowth * member.force, member.most);
    member.length = length;
    if (length > farthest) way *= farthest / length;
    // From the farthest way on the force is all; below it falls with the distance. Stiffer ones
    // would hold back what is closed already.
    const double stiffness = member.force / farthest;
    loads_.push_back({member.triangle, Vector3d::Unit(member.corner), place + way, Vector3d::Zero(),
                      stiffness * Eigen::Matrix3d::Identity()});
  }
  return loads_;
}

double SeamPull::gap(const std::vector<Vector3d>& positions) const {
  const std::vector<Vector3d> targets = middles(positions);
  double gap = 0.0;
  for (const Member& member : members_) {
    gap = std::max(gap, (positions[member.particle] - targets[member.group]).norm());
  }
  return gap;
}

int SeamPull::widestSeam(const std::vector<Vector3d>& positions) const {
  const std::vector<Vector3d> targets = middles(positions);
  double gap = -1.0;
  int widest = -1;
  for (const Member& member : members_) {
    const double its = (positions[member.particle] - targets[member.group]).norm();
    if (its <= gap) continue;
    gap = its;
    widest = member.seam;
  }
  return widest;
}

}  // namespace haptex::dressing
