#include "haptex/nodes/patch_triangles.h"

#include <algorithm>

namespace haptex::nodes {
namespace {

/// Sorted, each once.
std::vector<int> within(const std::vector<NearTriangle>& found, double excess) {
  std::vector<int> triangles;
  for (const NearTriangle& near : found) {
    if (near.excess <= excess) triangles.push_back(near.triangle);
  }
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  return triangles;
}

bool contains(const std::vector<int>& all, const std::vector<int>& some) {
  return std::includes(all.begin(), all.end(), some.begin(), some.end());
}

}  // namespace

bool PatchTriangles::isGoodEnough(const std::vector<NearTriangle>& found) const {
  return contains(triangles_, within(found, 0.0)) && contains(within(found, slack_), triangles_);
}

bool PatchTriangles::update(const std::vector<NearTriangle>& found) {
  if (isGoodEnough(found)) return false;
  triangles_ = within(found, 0.5 * slack_);
  return true;
}

}  // namespace haptex::nodes
