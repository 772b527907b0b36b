#include "haptex/nodes/common/cloth_recording.h"

#include <haptex/ClothMesh.h>
#include <ros/message_traits.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <stdexcept>

#include "haptex/nodes/common/bag_topics.h"
#include "haptex/nodes/common/proximity_messages.h"

namespace haptex::nodes {
namespace {

/// @throws std::invalid_argument naming the bag
Triangles trianglesOf(const ClothMesh& mesh, const std::string& bag) {
  try {
    return restMesh(mesh).triangles;
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(bag + ": " + error.what());
  }
}

Triangles readTriangles(const rosbag::Bag& bag) {
  Triangles triangles;
  rosbag::View view(bag, rosbag::TopicQuery(onlyTopic(
                             bag, ros::message_traits::datatype<ClothMesh>(), "cloth/mesh")));
  for (const rosbag::MessageInstance& instance : view) {
    const ClothMesh::ConstPtr message = instance.instantiate<ClothMesh>();
    if (!message) continue;
    Triangles newer = trianglesOf(*message, bag.getFileName());
    if (!triangles.empty() && newer != triangles) {
      throw std::invalid_argument(bag.getFileName() + ": the triangles change on the way");
    }
    triangles = std::move(newer);
  }
  if (triangles.empty()) throw std::invalid_argument(bag.getFileName() + ": no mesh of cloth");
  return triangles;
}

}  // namespace

void readClothRecording(const std::string& bag,
                        const std::function<void(const ClothState&, const Triangles&)>& visit) {
  rosbag::Bag file;
  try {
    file.open(bag, rosbag::bagmode::Read);
  } catch (const rosbag::BagException& error) {
    throw std::runtime_error(bag + ": cannot be read: " + error.what());
  }
  const Triangles triangles = readTriangles(file);
  rosbag::View view(file, rosbag::TopicQuery(onlyTopic(
                              file, ros::message_traits::datatype<ClothState>(), "cloth/state")));
  bool any = false;
  for (const rosbag::MessageInstance& instance : view) {
    const ClothState::ConstPtr message = instance.instantiate<ClothState>();
    if (!message) continue;
    any = true;
    visit(*message, triangles);
  }
  if (!any) throw std::invalid_argument(bag + ": no state of cloth");
}

}  // namespace haptex::nodes
