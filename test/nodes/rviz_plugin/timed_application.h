// A QApplication that knows which of its events took longest.
#pragma once

#include <QApplication>
#include <string>

namespace haptex::nodes {

/// How long an event kept the thread of the windows.
struct EventTime {
  double lasted = 0.0;    ///< ms
  double computed = 0.0;  ///< ms, of a processor for this thread; the rest it waited
  std::string event;      ///< its type, and the class of who received it
};

/// Measures the events that no other event has caused, and those of our panel and of what is in it,
/// also within others: painting the window is one event, and has one of every widget in it.
class TimedApplication : public QApplication {
 public:
  using QApplication::QApplication;

  bool notify(QObject* receiver, QEvent* event) override;

  /// The longest since forget().
  const EventTime& ofWindow() const { return of_window_; }
  const EventTime& ofPanel() const { return of_panel_; }
  void forget() { of_window_ = of_panel_ = {}; }

 private:
  EventTime of_window_, of_panel_;
  bool in_event_ = false, in_panel_ = false;
};

}  // namespace haptex::nodes
