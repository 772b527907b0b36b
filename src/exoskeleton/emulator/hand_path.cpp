#include "haptex/exoskeleton/emulator/hand_path.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "haptex/base/yaml_reader.h"
#include "haptex/exoskeleton/control/minimum_jerk.h"

namespace haptex::exoskeleton {
namespace {

using base::YamlValue;
using Eigen::Vector3d;

constexpr double kLongestTime = 3600.0;     // s
constexpr double kFarthestFingertip = 1.0;  // m from hand_base, per coordinate
constexpr double kFarthestHand = 100.0;     // m from world, per coordinate: as in scene files
constexpr double kSamePlace = 1e-9;         // m, and of the entries of a rotation

bool same(const HandPlace& a, const HandPlace& b) {
  for (const Finger finger : kFingers) {
    if ((a.fingertips[finger] - b.fingertips[finger]).norm() > kSamePlace) return false;
  }
  return (a.hand_base.matrix() - b.hand_base.matrix()).norm() <= kSamePlace;
}

HandPlace between(const HandPlace& from, const HandPlace& to, double share) {
  HandPlace place;
  place.phase = from.phase;
  for (const Finger finger : kFingers) {
    place.fingertips[finger] =
        from.fingertips[finger] + share * (to.fingertips[finger] - from.fingertips[finger]);
  }
  const Eigen::Quaterniond start(from.hand_base.linear()), end(to.hand_base.linear());
  place.hand_base.linear() = start.slerp(share, end).toRotationMatrix();
  place.hand_base.translation() =
      from.hand_base.translation() +
      share * (to.hand_base.translation() - from.hand_base.translation());
  return place;
}

Vector3d readVector(const YamlValue& value, double largest) {
  const auto items = value.items(3);
  Vector3d vector;
  for (int i = 0; i < 3; ++i) {
    vector[i] = items[i].number();
    if (std::abs(vector[i]) > largest) {
      std::ostringstream reason;
      reason << "must be from " << -largest << " to " << largest << " m";
      items[i].refuse(reason.str());
    }
  }
  return vector;
}

Eigen::Matrix3d readRotation(const YamlValue& value) {
  const auto items = value.items(3);
  using Eigen::AngleAxisd;
  return (AngleAxisd(items[2].number(), Vector3d::UnitZ()) *
          AngleAxisd(items[1].number(), Vector3d::UnitY()) *
          AngleAxisd(items[0].number(), Vector3d::UnitX()))
      .toRotationMatrix();
}

KeyFrame readKeyFrame(const YamlValue& value) {
  value.requireKeys({"time", "index", "thumb", "position"}, {"rpy", "phase"});
  KeyFrame frame;
  frame.time = value.at("time").number();
  if (frame.time < 0.0 || frame.time > kLongestTime) {
    value.at("time").refuse("must be from 0 to 3600 s");
  }
  for (const Finger finger : kFingers) {
    frame.place.fingertips[finger] = readVector(value.at(name(finger)), kFarthestFingertip);
  }
  frame.place.hand_base.translation() = readVector(value.at("position"), kFarthestHand);
  if (value.has("rpy")) frame.place.hand_base.linear() = readRotation(value.at("rpy"));
  if (value.has("phase")) frame.phase = value.at("phase").text();
  return frame;
}

// The defect of a key frame in its sequence, or empty.
std::string defect(const std::vector<KeyFrame>& frames, std::size_t i) {
  const double time = frames[i].time;
  if (i == 0 && time != 0.0) return "the first time must be 0";
  if (i > 0 && !(time > frames[i - 1].time)) return "must be later than the key frame before";
  return "";
}

bool readRepeat(const YamlValue& file) {
  return file.has("repeat") && file.at("repeat").oneOf({"true", "false"}) == "true";
}

}  // namespace

HandPath::HandPath(std::vector<KeyFrame> key_frames, bool repeats)
    : key_frames_(std::move(key_frames)), repeats_(repeats) {
  if (key_frames_.empty()) throw std::invalid_argument("a hand path needs a key frame");
  for (std::size_t i = 0; i < key_frames_.size(); ++i) {
    std::ostringstream name;
    name << "key frame " << i << ", time " << key_frames_[i].time << " s: ";
    if (!std::isfinite(key_frames_[i].time)) {
      throw std::invalid_argument(name.str() + "must be finite");
    }
    const std::string wrong = defect(key_frames_, i);
    if (!wrong.empty()) throw std::invalid_argument(name.str() + wrong);
  }
  for (KeyFrame& frame : key_frames_) {
    if (!frame.phase.empty()) phases_.push_back(frame.phase);
    frame.place.phase = static_cast<int>(phases_.size()) - 1;
  }
  if (!repeats_) return;
  if (key_frames_.size() < 2) {
    throw std::invalid_argument("a hand path that repeats needs two key frames");
  }
  if (!same(key_frames_.front().place, key_frames_.back().place)) {
    throw std::invalid_argument("a hand path that repeats must end where it starts");
  }
}

HandPlace HandPath::at(double time) const {
  if (repeats_ && time > 0.0) time = std::fmod(time, duration());
  if (time <= 0.0) return key_frames_.front().place;
  const auto next =
      std::upper_bound(key_frames_.begin(), key_frames_.end(), time,
                       [](double asked, const KeyFrame& frame) { return asked < frame.time; });
  if (next == key_frames_.end()) return key_frames_.back().place;
  const KeyFrame& from = *(next - 1);
  const double share = (time - from.time) / (next->time - from.time);
  return between(from.place, next->place, minimumJerk(share));
}

HandPath loadHandPath(const std::string& path) {
  const YamlValue file = YamlValue::load(path);
  file.requireKeys({"key_frames"}, {"repeat"});
  const YamlValue list = file.at("key_frames");
  std::vector<KeyFrame> frames;
  for (const YamlValue& item : list.items()) {
    frames.push_back(readKeyFrame(item));
    const std::string wrong = defect(frames, frames.size() - 1);
    if (!wrong.empty()) item.at("time").refuse(wrong);
  }
  const bool repeats = readRepeat(file);
  try {
    return HandPath(std::move(frames), repeats);
  } catch (const std::invalid_argument& error) {
    list.refuseBecause(error.what());
  }
}

}  // namespace haptex::exoskeleton
