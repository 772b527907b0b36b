#include "haptex/nodes/cloth_simulation/point_load_messages.h"

#include <sstream>
#include <stdexcept>
#include <string>

#include "haptex/cloth/dynamics/cloth.h"
#include "haptex/nodes/common/cloth_messages.h"

namespace haptex::nodes {
namespace {

void requireLength(const char* name, std::size_t length, std::size_t points, std::size_t each) {
  if (length == each * points) return;
  throw std::invalid_argument(std::string(name) + " has " + std::to_string(length) +
                              " elements and triangles " + std::to_string(points) +
                              ": allowed is " + std::to_string(each) + " for each triangle");
}

/// Before anything is computed of the numbers: squares of 1e308 are not finite.
template <typename Numbers>
void requireWithin(const char* name, std::size_t point, const Numbers& numbers, double largest,
                   const char* unit) {
  if (!numbers.allFinite()) return;  // which checkedLoad() says
  if (numbers.cwiseAbs().maxCoeff() <= largest && numbers.norm() <= largest) return;
  std::ostringstream message;
  message << name << " of point " << point << " = ("
          << numbers.template reshaped<Eigen::RowMajor>().transpose()
          << "): allowed are numbers of a norm up to " << largest << ' ' << unit;
  throw std::invalid_argument(message.str());
}

}  // namespace

std::vector<cloth::PointLoad> pointLoads(const haptex::ContactForces& message,
                                         std::size_t triangle_count) {
  requireFixedFrame(message.header);
  const std::size_t points = message.triangles.size();
  if (points > cloth::PointLoads::kMax) {
    throw std::invalid_argument("triangles has " + std::to_string(points) +
                                " elements: allowed are " +
                                std::to_string(cloth::PointLoads::kMax));
  }
  requireLength("barycentric", message.barycentric.size(), points, 3);
  requireLength("positions", message.positions.size(), points, 1);
  requireLength("forces", message.forces.size(), points, 1);
  requireLength("stiffness", message.stiffness.size(), points, 9);
  std::vector<cloth::PointLoad> loads;
  loads.reserve(points);
  for (std::size_t i = 0; i < points; ++i) {
    if (message.triangles[i] >= triangle_count) {  // before it may wrap to a negative index
      throw std::invalid_argument(
          "triangles[" + std::to_string(i) + "] = " + std::to_string(message.triangles[i]) +
          " does not exist: allowed are 0 to " + std::to_string(triangle_count - 1));
    }
    const auto& position = message.positions[i];
    const auto& force = message.forces[i];
    cloth::PointLoad load;
    load.triangle = static_cast<int>(message.triangles[i]);
    load.weights = Eigen::Map<const Eigen::Vector3d>(&message.barycentric[3 * i]);
    load.position = {position.x, position.y, position.z};
    load.force = {force.x, force.y, force.z};
    load.stiffness =
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(&message.stiffness[9 * i]);
    requireWithin("force", i, load.force, kMaxPointForce, "N");
    requireWithin("stiffness", i, load.stiffness, kMaxPointStiffness, "N/m");
    requireWithin("position", i, load.position, kFarthestPoint, "m");
    requireWithin("weights", i, load.weights, kMaxWeights, "");
    loads.push_back(cloth::checkedLoad(load, i, triangle_count));
  }
  return loads;
}

}  // namespace haptex::nodes
