#include "haptex/nodes/record_topics/bag_recorder.h"

#include <ros/master.h>
#include <ros/ros.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

namespace haptex::nodes {
namespace {

constexpr auto kSuffix = ".active";

bool matchesAny(const std::string& topic, const std::vector<std::regex>& expressions) {
  return std::any_of(expressions.begin(), expressions.end(), [&](const std::regex& expression) {
    return std::regex_match(topic, expression);
  });
}

/// What follows the namespace, or nothing if the topic is in another.
std::string within(const std::string& space, const std::string& topic) {
  const std::string begin = space == "/" ? space : space + "/";
  return topic.compare(0, begin.size(), begin) == 0 ? topic.substr(begin.size()) : "";
}

}  // namespace

bool RecordedTopics::match(const std::string& topic) const {
  const std::string inner = within(space, topic);
  const auto matches = [&](const std::vector<std::regex>& expressions) {
    return matchesAny(topic, expressions) || (!inner.empty() && matchesAny(inner, expressions));
  };
  return matches(wanted) && !matches(excluded);
}

BagRecorder::BagRecorder(std::string path, RecordedTopics topics)
    : path_(std::move(path)), topics_(std::move(topics)), bag_(std::make_unique<rosbag::Bag>()) {
  node_.setCallbackQueue(&queue_);
  bag_->setCompression(rosbag::compression::LZ4);
  bag_->open(path_ + kSuffix, rosbag::bagmode::Write);
  searching_ = std::thread([this] { search(); });
}

BagRecorder::~BagRecorder() {
  ros::requestShutdown();
  searching_.join();
  try {
    queue_.callAvailable();
    bag_->close();
    std::filesystem::rename(path_ + kSuffix, path_);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s is not complete: %s\n", path_.c_str(), error.what());
    // Its destructor closes again, and what that throws would end the process then and there.
    static_cast<void>(bag_.release());
  }
}

void BagRecorder::run() {
  while (ros::ok()) {
    std::this_thread::sleep_for(kWritePeriod);
    try {
      queue_.callAvailable();
    } catch (const rosbag::BagException& error) {
      ROS_ERROR(
          "%s is not written any more: %s. Free space on its disk if it is full, and start a "
          "recorder "
          "again; rosbag reindex makes readable what is in it",
          (path_ + kSuffix).c_str(), error.what());
      throw;
    }
  }
}

void BagRecorder::search() {
  auto next = std::chrono::steady_clock::now();
  while (ros::ok()) {
    if (std::chrono::steady_clock::now() >= next) {
      next += kSearchPeriod;
      lookForSpace();
      ros::master::V_TopicInfo published;
      ros::master::getTopics(published);
      for (const ros::master::TopicInfo& topic : published) {
        if (topics_.match(topic.name)) subscribe(topic.name);
      }
    }
    std::this_thread::sleep_for(kWritePeriod);
  }
  subscribers_.clear();
}

void BagRecorder::subscribe(const std::string& topic) {
  if (subscribers_.count(topic) != 0) return;
  constexpr std::uint32_t kAll = 0;  // wait until they are written
  ros::SubscribeOptions options;
  options.initByFullCallbackType<const Message&>(
      topic, kAll, [this, topic](const Message& message) { write(topic, message); });
  subscribers_[topic] = node_.subscribe(options);
}

void BagRecorder::write(const std::string& topic, const Message& message) {
  if (!has_space_) return;
  bag_->write(topic, message.getReceiptTime(), *message.getConstMessage(),
              message.getConnectionHeaderPtr());
}

void BagRecorder::lookForSpace() {
  std::error_code error;
  const auto directory = std::filesystem::absolute(path_).parent_path();
  const std::filesystem::space_info space = std::filesystem::space(directory, error);
  const bool has_space = !error && space.available >= kMinSpace;
  if (has_space_.exchange(has_space) && !has_space) {
    ROS_ERROR(
        "%s is not written any more: less than 1 GiB is free in %s. It goes on when there is more",
        path_.c_str(), directory.c_str());
  }
}

}  // namespace haptex::nodes
