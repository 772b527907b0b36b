// What a person is told of the nodes of one graph.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "haptex/base/clock.h"
#include "haptex/base/finger.h"

namespace haptex::nodes {

/// One status of /diagnostics.
struct Diagnosis {
  enum class Level { kOk, kWarn, kError };
  Level level = Level::kOk;
  std::string message;
  std::map<std::string, std::string> values;
  double stamp = 0.0;  ///< s, when the node said so, by its clock: messages may arrive together
  std::string replayed_by = "";  ///< who sent it, if not the node that it is of: rosbag
};

/// exoskeleton/operating_state.
struct DeviceState {
  std::string state;  ///< DISABLED, ENABLED, PAUSED or FAULT
  bool is_homed = false;
  bool is_busy = false;
  std::string fault;
};

/// A sentence for the head of the panel.
struct StatusLine {
  enum class Mood { kWell, kAttention, kTrouble };
  Mood mood;
  std::string text;
};

/// A row of figures.
struct Figure {
  std::string name;
  std::string value;
};

/// Collects what nodes say of themselves, and says in words why a finger feels no force, or that
/// all is well: of several reasons the one to be mended first. Knows neither ROS nor Qt and reads
/// no clock: times are of a steady one. What a bag replays is told apart from what nodes say.
class SystemStatus {
 public:
  using Time = base::Time;

  /// Diagnostics come once a second: a node that is silent for longer has stopped or hangs.
  static constexpr Time kSilent = std::chrono::milliseconds(3500);
  /// operating_state comes ten times a second.
  static constexpr Time kDeviceSilent = std::chrono::milliseconds(1000);

  /// @param name of the status without the node's, for example "cloth simulation"
  void hear(const std::string& name, Diagnosis diagnosis, Time now);
  void hear(DeviceState state, Time now);

  StatusLine line(Time now) const;

  /// Rates, dips and budget, as far as they are known.
  std::vector<Figure> figures(Time now) const;

 private:
  struct Heard {
    Diagnosis diagnosis;
    Time time{};
    std::optional<double> rate;  // periods per second, where it counts them
    double missed_lately = 0.0;  // periods, since the one before
  };

  void forgetReplay();
  bool isLive(const std::string& name, Time now) const;
  const Heard* find(const std::string& name) const;
  std::optional<StatusLine> replay(Time now) const;
  std::optional<StatusLine> clothTrouble(Time now) const;
  std::optional<StatusLine> deviceTrouble(Time now) const;
  std::optional<StatusLine> stateTrouble() const;
  std::optional<StatusLine> forceTrouble(Time now) const;
  StatusLine allIsWell(Time now) const;
  std::string feelings() const;
  std::string warnings(Time now) const;

  std::map<std::string, Heard> heard_;
  std::optional<DeviceState> device_;
  Time device_time_{};
};

}  // namespace haptex::nodes
