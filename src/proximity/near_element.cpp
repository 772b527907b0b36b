#include "haptex/proximity/near_element.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>

namespace haptex::proximity {

void requireValid(const Range& range) {
  if (range.distance >= 0.0) return;  // false for NaN
  std::ostringstream message;
  message << "distance of a proximity query " << range.distance << " m: must be >= 0";
  throw std::invalid_argument(message.str());
}

NearElement nearElement(int index, const Triangle& triangle, const Cursor& cursor) {
  NearElement nearest;
  nearest.triangle = index;
  nearest.part = -1;
  for (std::size_t part = 0; part < cursor.parts().size(); ++part) {
    const TrianglePoint point = closestPoint(triangle, cursor.parts()[part]);
    if (nearest.part >= 0 && !(point.distance < nearest.distance)) continue;
    nearest.part = static_cast<int>(part);
    nearest.distance = point.distance;
    nearest.barycentric = point.barycentric;
  }
  nearest.point = TrianglePoint{nearest.distance, nearest.barycentric}.on(triangle);
  nearest.normal = unitNormal(triangle);
  return nearest;
}

std::vector<NearElement> nearElementsByBruteForce(const std::vector<std::array<int, 3>>& triangles,
                                                  const std::vector<Eigen::Vector3d>& positions,
                                                  const Cursor& cursor, const Range& range) {
  requireValid(range);
  std::vector<NearElement> found;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const auto& corners = triangles[i];
    const NearElement element =
        nearElement(static_cast<int>(i),
                    {positions[corners[0]], positions[corners[1]], positions[corners[2]]}, cursor);
    if (element.distance <= range.distance) found.push_back(element);
  }
  std::sort(found.begin(), found.end(), isNearer);
  if (found.size() > range.count) found.resize(range.count);
  return found;
}

}  // namespace haptex::proximity
