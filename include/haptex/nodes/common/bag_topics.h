// Which topic of a bag is meant.
#pragma once

#include <rosbag/bag.h>

#include <string>

namespace haptex::nodes {

/// The only topic of a type, such as "haptex/Tactile", whose last names are these, such as
/// "thumb/tactile".
/// @throws std::invalid_argument naming the bag and its topics of the type unless there is just one
std::string onlyTopic(const rosbag::Bag& bag, const std::string& type, const std::string& names);

}  // namespace haptex::nodes
