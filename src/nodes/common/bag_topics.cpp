#include "haptex/nodes/common/bag_topics.h"

#include <rosbag/view.h>

#include <set>
#include <sstream>
#include <stdexcept>

namespace haptex::nodes {
namespace {

bool endsIn(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

}  // namespace

std::string onlyTopic(const rosbag::Bag& bag, const std::string& type, const std::string& names) {
  rosbag::View all(bag, rosbag::TypeQuery(type));
  std::set<std::string> known, meant;
  for (const rosbag::ConnectionInfo* const connection : all.getConnections()) {
    known.insert(connection->topic);
    if (endsIn("/" + connection->topic, "/" + names)) meant.insert(connection->topic);
  }
  if (meant.size() == 1) return *meant.begin();
  std::ostringstream message;
  message << bag.getFileName() << ": " << meant.size() << " topics end in " << names
          << ", one is needed; of " << type << " there " << (known.empty() ? "is none" : "is");
  for (const std::string& topic : known) message << ' ' << topic;
  throw std::invalid_argument(message.str());
}

}  // namespace haptex::nodes
