// Records topics into a bag, at little cost for the others on the machine.
#pragma once

#include <ros/callback_queue.h>
#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <rosbag/bag.h>
#include <topic_tools/shape_shifter.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <regex>
#include <string>
#include <thread>
#include <vector>

namespace haptex::nodes {

/// Which topics are recorded: regular expressions (ECMAScript) that have to match whole names, or
/// what of a name follows the node's namespace and its slash.
struct RecordedTopics {
  std::vector<std::regex> wanted;
  std::vector<std::regex> excluded;
  std::string space = "/";  ///< of the node

  bool match(const std::string& topic) const;
};

/// Messages wait where they arrive and are written all together, kWritePeriod after the last time,
/// so that one thread is woken up fifty times a second: rosbag's record wakes one of ten up for
/// every message. They carry the time at which they arrived. Chunks are compressed by LZ4. Until it
/// is closed the bag has the suffix .active. Where less than kMinSpace is left on the disk,
/// nothing is written, which is said on the console.
class BagRecorder {
 public:
  static constexpr std::chrono::milliseconds kWritePeriod{20};
  static constexpr std::chrono::seconds kSearchPeriod{1};               ///< for new topics
  static constexpr std::uintmax_t kMinSpace = std::uintmax_t{1} << 30;  ///< bytes

  /// @throws rosbag::BagException if the bag cannot be made
  BagRecorder(std::string path, RecordedTopics topics);
  /// Closes the bag. What came since the last time of writing may be missing: roscpp drops what
  /// waits for its subscribers when it is shut down.
  ~BagRecorder();
  BagRecorder(const BagRecorder&) = delete;
  BagRecorder& operator=(const BagRecorder&) = delete;

  /// Until roscpp is shut down.
  /// @throws rosbag::BagException if the bag cannot be written
  void run();

 private:
  using Message = ros::MessageEvent<const topic_tools::ShapeShifter>;

  void search();
  void subscribe(const std::string& topic);
  void write(const std::string& topic, const Message& message);
  void lookForSpace();

  const std::string path_;
  const RecordedTopics topics_;
  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  std::unique_ptr<rosbag::Bag> bag_;
  std::map<std::string, ros::Subscriber> subscribers_;  // of the searching thread
  std::atomic<bool> has_space_{true};
  std::thread searching_;
};

}  // namespace haptex::nodes
