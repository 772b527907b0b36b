// record_topics BAG [--exclude REGEX]... REGEX...: see haptex/nodes/record_topics/bag_recorder.h.
#include <ros/ros.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <regex>
#include <stdexcept>
#include <string>
#include <vector>

#include "haptex/base/quoted.h"
#include "haptex/nodes/record_topics/bag_recorder.h"

namespace {

std::regex expressionOf(const std::string& text) {
  try {
    return std::regex(text);
  } catch (const std::regex_error& error) {
    throw std::invalid_argument(haptex::base::quoted(text) +
                                " is no regular expression: " + error.what());
  }
}

haptex::nodes::RecordedTopics topicsOf(const std::vector<std::string>& words) {
  haptex::nodes::RecordedTopics topics;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool excludes = words[i] == "--exclude";
    if (excludes && ++i == words.size()) {
      throw std::invalid_argument("--exclude: a regular expression has to follow");
    }
    (excludes ? topics.excluded : topics.wanted).push_back(expressionOf(words[i]));
  }
  if (topics.wanted.empty()) throw std::invalid_argument("no topic to record is named");
  return topics;
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "record_topics");
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow any more is told like a full disk
  try {
    if (argc < 2) throw std::invalid_argument("no bag is named");
    haptex::nodes::RecordedTopics topics = topicsOf({argv + 2, argv + argc});
    topics.space = ros::this_node::getNamespace();
    haptex::nodes::BagRecorder(argv[1], std::move(topics)).run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "record_topics: %s\n", error.what());
    return 1;
  }
  return 0;
}
