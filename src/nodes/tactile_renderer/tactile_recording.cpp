#include "haptex/nodes/tactile_renderer/tactile_recording.h"

#include <haptex/Tactile.h>
#include <ros/message_traits.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "haptex/nodes/common/bag_topics.h"
#include "haptex/tactile/drive_waveform.h"

namespace haptex::nodes {
namespace {

constexpr double kMetresPerMicrometre = 1e-6;

struct Recorded {
  double stamp;  // s, since the first message
  tactile::PerChannel<double> amplitudes;
};

std::vector<Recorded> readMessages(const rosbag::Bag& bag, const std::string& topic,
                                   int contactor) {
  std::vector<Recorded> messages;
  ros::Time first;
  rosbag::View view(bag, rosbag::TopicQuery(topic));
  for (const rosbag::MessageInstance& instance : view) {
    const Tactile::ConstPtr message = instance.instantiate<Tactile>();
    if (!message) continue;
    if (messages.empty()) first = message->header.stamp;
    messages.push_back({(message->header.stamp - first).toSec(),
                        {kMetresPerMicrometre * message->amplitudes_40[contactor],
                         kMetresPerMicrometre * message->amplitudes_320[contactor]}});
  }
  // Bags are in the order of arrival.
  std::stable_sort(messages.begin(), messages.end(),
                   [](const Recorded& a, const Recorded& b) { return a.stamp < b.stamp; });
  return messages;
}

/// The newest amplitudes at every step, as long as they are not older than a step and a half.
tactile::ContactorSteps inSteps(const std::vector<Recorded>& messages) {
  tactile::ContactorSteps steps;
  if (messages.empty()) return steps;
  const double begin = messages.front().stamp;
  const double length = messages.back().stamp - begin;
  if (!(length <= tactile::kLongestSound)) {
    std::ostringstream message;
    message << "the recording is " << length << " s long: allowed are up to "
            << tactile::kLongestSound << " s";
    throw std::invalid_argument(message.str());
  }
  const auto count = std::lround(length / tactile::kTactileStep) + 1;
  std::size_t newest = 0;
  for (long i = 0; i < count; ++i) {
    // Half a step of tolerance, so that jitter of the stamps neither drops nor doubles messages.
    const double latest = begin + (static_cast<double>(i) + 0.5) * tactile::kTactileStep;
    while (newest + 1 < messages.size() && messages[newest + 1].stamp <= latest) ++newest;
    const bool is_fresh = latest - messages[newest].stamp <= 1.5 * tactile::kTactileStep;
    steps.push_back(is_fresh ? messages[newest].amplitudes : tactile::PerChannel<double>{});
  }
  return steps;
}

}  // namespace

tactile::ContactorSteps recordedSteps(const std::string& bag, const std::string& finger,
                                      int contactor) {
  if (contactor < 0 || contactor >= tactile::kContactors) {
    throw std::invalid_argument("contactor " + std::to_string(contactor) + ": allowed are 0 to " +
                                std::to_string(tactile::kContactors - 1));
  }
  rosbag::Bag file;
  try {
    file.open(bag, rosbag::bagmode::Read);
  } catch (const rosbag::BagException& error) {
    throw std::runtime_error(bag + ": cannot be read: " + error.what());
  }
  return inSteps(readMessages(
      file, onlyTopic(file, ros::message_traits::datatype<Tactile>(), finger + "/tactile"),
      contactor));
}

}  // namespace haptex::nodes
