#include "haptex/nodes/wire/frame_names.h"

#include <regex>
#include <stdexcept>

#include "haptex/base/quoted.h"
#include "haptex/scene/frame_name.h"

namespace haptex::nodes {
namespace {

struct FrameNames {
  explicit FrameNames(const std::string& before)
      : prefix(before), fixed(before + "world"), hand(before + "hand_base") {
    for (const base::Finger finger : base::kFingers) {
      tip[finger] = before + base::name(finger) + "_tip";
      array[finger] = before + base::name(finger) + "_tactile";
    }
  }

  std::string prefix, fixed, hand;
  base::PerFinger<std::string> tip, array;
};

FrameNames& names() {
  static FrameNames names("");
  return names;
}

}  // namespace

void setFramePrefix(const std::string& prefix) {
  static const std::regex allowed("|\\w+(/\\w+)*");
  // The expression is matched by recursion: a long text would take the stack.
  if (prefix.size() > base::kLongestQuote || !std::regex_match(prefix, allowed)) {
    throw std::invalid_argument("tf_prefix = " + base::quoted(prefix) +
                                ": allowed are letters, digits and _, in parts between slashes, up "
                                "to 200 characters, or nothing");
  }
  names() = FrameNames(prefix.empty() ? "" : prefix + "/");
}

std::string frameCalled(const std::string& name) { return names().prefix + name; }

std::string carryingFrame(const std::string& frame_id) {
  const std::string& prefix = framePrefix();
  if (frame_id.rfind(prefix, 0) == 0) {
    const std::string name = frame_id.substr(prefix.size());
    if (scene::isFrameName(name)) return name;
  }
  const std::string before = prefix.empty() ? "" : "'" + prefix + "' and ";
  throw std::invalid_argument("header.frame_id = " + base::quoted(frame_id) + ": allowed is '" +
                              fixedFrame() + "', or a frame that carries the particles: " + before +
                              scene::kFrameNames);
}

const std::string& framePrefix() { return names().prefix; }

const std::string& fixedFrame() { return names().fixed; }

const std::string& handFrame() { return names().hand; }

const std::string& tipFrame(base::Finger finger) { return names().tip[finger]; }

const std::string& arrayFrame(base::Finger finger) { return names().array[finger]; }

}  // namespace haptex::nodes
