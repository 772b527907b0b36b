// Scripted movements of a hand and its two fingertips, read from a file: docs/path_files.md.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "haptex/exoskeleton/finger.h"

namespace haptex::exoskeleton {

/// Where a hand is and where its fingertips want to be.
struct HandPlace {
  PerFinger<Eigen::Vector3d> fingertips{
      {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()}};      ///< m, in hand_base
  Eigen::Isometry3d hand_base = Eigen::Isometry3d::Identity();  ///< its pose in world (m)
  int phase = 0;  ///< which of HandPath::phases() this belongs to
};

struct KeyFrame {
  double time;  ///< s since the start
  HandPlace place;
  std::string phase = {};  ///< name of the phase that begins here; empty: none does
};

/// Goes from key frame to key frame and rests for a moment at each.
class HandPath {
 public:
  /// @param key_frames the first at time 0, times increasing
  /// @param repeats    starts again at the time of the last key frame, which is to be as the first
  /// @throws std::invalid_argument naming the key frame and what is wrong with it
  HandPath(std::vector<KeyFrame> key_frames, bool repeats);

  /// The place at a time (s, finite) since the start; before it the first one, after the end the
  /// last one unless the path repeats. Positions move on straight lines, orientations about a fixed
  /// axis, with minimum jerk, see minimum_jerk.h.
  HandPlace at(double time) const;

  double duration() const { return key_frames_.back().time; }  ///< s
  bool repeats() const { return repeats_; }
  /// Names in the order of their begin. The first, empty, is that of the time before any.
  const std::vector<std::string>& phases() const { return phases_; }

 private:
  std::vector<KeyFrame> key_frames_;
  bool repeats_;
  std::vector<std::string> phases_{""};
};

/// Reads a path file; docs/path_files.md describes the format.
/// @throws std::runtime_error naming the file, and the line if it is not YAML
/// @throws std::invalid_argument naming file, key, value and what is allowed
HandPath loadHandPath(const std::string& file);

}  // namespace haptex::exoskeleton
