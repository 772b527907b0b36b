// What the displays of rviz have in common.
#pragma once

#include <rviz/display.h>
#include <std_msgs/Header.h>

#include <map>
#include <string>
#include <utility>

#include "haptex/nodes/rviz_plugin/background_subscriptions.h"

namespace haptex::nodes {

/// Listens to topics while it is switched on, says in its statuses what is wrong, and lies where
/// the newest transform of its messages' frame has it. A destructor has to end subscriptions_,
/// whose callbacks use what the display shows.
class LiveDisplay : public rviz::Display {
 public:
  void update(float wall_dt, float ros_dt) override;
  void reset() override;

 protected:
  void onEnable() override { subscribe(); }
  void onDisable() override;

  /// Adds the topics to subscriptions_. @returns whether there are any
  virtual bool addTopics() = 0;
  /// What was shown is shown no more.
  virtual void forget() = 0;
  /// Once a frame, when the messages that have come were taken.
  virtual void refresh() = 0;

  /// Anew, without what was shown.
  void subscribe();
  /// In the newest place of a frame: what is drawn does not wait for a transform.
  /// @returns whether there is a transform
  bool place(const std_msgs::Header& header);
  /// Only what is new: rviz makes an event of every status.
  void say(const std::string& what, rviz::StatusProperty::Level level, const std::string& text);
  void refuse(const std::string& what, const std::string& why);
  /// There is nothing to be said of that any more.
  void unsay(const std::string& what);

  BackgroundSubscriptions subscriptions_;

 private:
  void clear();

  std::map<std::string, std::pair<int, std::string>> said_;  // level and text of each status
};

}  // namespace haptex::nodes
