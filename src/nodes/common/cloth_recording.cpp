#include "haptex/nodes/common/cloth_recording.h"

#include <haptex/ClothMesh.h>
#include <ros/message_traits.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <set>
#include <sstream>
#include <stdexcept>

#include "haptex/nodes/common/proximity_messages.h"

namespace haptex::nodes {
namespace {

bool endsIn(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// The one topic of this type that is meant.
template <typename Message>
std::string topicOf(const rosbag::Bag& bag, const std::string& name) {
  const std::string type = ros::message_traits::datatype<Message>();
  rosbag::View all(bag, rosbag::TypeQuery(type));
  std::set<std::string> known, meant;
  for (const rosbag::ConnectionInfo* const connection : all.getConnections()) {
    known.insert(connection->topic);
    if (endsIn("/" + connection->topic, "/" + name)) meant.insert(connection->topic);
  }
  if (meant.size() == 1) return *meant.begin();
  std::ostringstream message;
  message << bag.getFileName() << ": " << meant.size() << " topics end in " << name
          << ", one is needed; of " << type << " there " << (known.empty() ? "is none" : "is");
  for (const std::string& topic : known) message << ' ' << topic;
  throw std::invalid_argument(message.str());
}

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
  rosbag::View view(bag, rosbag::TopicQuery(topicOf<ClothMesh>(bag, "cloth/mesh")));
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
  rosbag::View view(file, rosbag::TopicQuery(topicOf<ClothState>(file, "cloth/state")));
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
