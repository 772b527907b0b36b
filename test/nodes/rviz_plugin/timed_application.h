// A QApplication that knows which of its events took longest.
#pragma once

#include <QApplication>
#include <string>

namespace haptex::nodes {

/// How long something kept the thread of the windows, ms.
struct TimeSpent {
  double lasted = 0.0;
  double computed = 0.0;  ///< by a processor
  double queued = 0.0;    ///< for a processor, which others had
  std::string what;

  /// For anything else: a lock, an answer, the threads that draw in software.
  double waited() const { return lasted - computed - queued; }
};

/// Measures from its construction on.
class Stopwatch {
 public:
  Stopwatch();

  TimeSpent read(std::string what) const;

 private:
  TimeSpent begin_;
};

/// Measures the events that no other event has caused, and those of our panel and of what is in it,
/// also within others: painting the window is one event, and has one of every widget in it.
class TimedApplication : public QApplication {
 public:
  using QApplication::QApplication;

  bool notify(QObject* receiver, QEvent* event) override;

  /// The longest since forget().
  const TimeSpent& ofWindow() const { return of_window_; }
  const TimeSpent& ofPanel() const { return of_panel_; }
  void forget() { of_window_ = of_panel_ = {}; }

 private:
  TimeSpent of_window_, of_panel_;
  bool in_event_ = false, in_panel_ = false;
};

}  // namespace haptex::nodes
