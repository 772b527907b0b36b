#include "haptex/studies/drape_shadow.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace haptex::studies {

std::vector<double> shadowRadii(const mesh::ClothMesh& mesh, int count) {
  std::vector<double> radii(count, 0.0);
  const double step = 2.0 * M_PI / count;
  for (const auto& triangle : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector2d p = mesh.initial_positions[triangle[i]].head<2>();
      const Eigen::Vector2d q = mesh.initial_positions[triangle[(i + 1) % 3]].head<2>();
      const double begin = std::atan2(p.y(), p.x());
      // The shorter way round; edges through the origin are not at the shadow's edge.
      const double sweep = std::remainder(std::atan2(q.y(), q.x()) - begin, 2.0 * M_PI);
      const double low = std::min(begin, begin + sweep), high = std::max(begin, begin + sweep);
      for (int k = static_cast<int>(std::ceil(low / step)); k <= std::floor(high / step); ++k) {
        const Eigen::Vector2d ray(std::cos(k * step), std::sin(k * step));
        const Eigen::Vector2d across(-ray.y(), ray.x());
        const double a = across.dot(p), b = across.dot(q);
        const double share = a == b ? 0.0 : std::min(1.0, std::max(0.0, a / (a - b)));
        double& radius = radii[((k % count) + count) % count];
        radius = std::max(radius, ray.dot(p + share * (q - p)));
      }
    }
  }
  return radii;
}

double drapeCoefficient(const std::vector<double>& radii, double fabric_radius,
                        double support_radius) {
  double squares = 0.0;
  for (double radius : radii) squares += radius * radius / static_cast<double>(radii.size());
  const double support = support_radius * support_radius;
  return (squares - support) / (fabric_radius * fabric_radius - support);
}

int countNodes(const std::vector<double>& radii, double prominence) {
  if (radii.empty()) return 0;
  const int count = static_cast<int>(radii.size());
  const int start = static_cast<int>(std::min_element(radii.begin(), radii.end()) - radii.begin());
  int nodes = 0;
  double low = radii[start], high = low;  // since the last maximum and minimum
  bool rising = true;                     // looks for the next maximum
  for (int i = 1; i <= count; ++i) {
    const double radius = radii[(start + i) % count];
    if (rising) {
      low = std::min(low, radius);
      if (radius > low + prominence) rising = false, ++nodes, high = radius;
    } else {
      high = std::max(high, radius);
      if (radius < high - prominence) rising = true, low = radius;
    }
  }
  return nodes;
}

}  // namespace haptex::studies
