#include "timed_application.h"

#include <QMetaEnum>
#include <ctime>
#include <fstream>
#include <utility>

#include "haptex/nodes/rviz_plugin/panel.h"

namespace haptex::nodes {
namespace {

double milliseconds(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

/// Since the thread began. The second number of /proc/thread-self/schedstat (Linux) is ns queued.
TimeSpent spentSoFar() {
  double computed = 0.0, queued = 0.0;
  std::ifstream("/proc/thread-self/schedstat") >> computed >> queued;
  return {milliseconds(CLOCK_MONOTONIC), milliseconds(CLOCK_THREAD_CPUTIME_ID), 1e-6 * queued, ""};
}

std::string nameOf(QEvent::Type type) {
  const char* name = QMetaEnum::fromType<QEvent::Type>().valueToKey(type);
  return name != nullptr ? name : "event " + std::to_string(type);
}

bool isOfPanel(const QObject* object) {
  while (object != nullptr && dynamic_cast<const Panel*>(object) == nullptr) {
    object = object->parent();
  }
  return object != nullptr;
}

}  // namespace

Stopwatch::Stopwatch() : begin_(spentSoFar()) {}

TimeSpent Stopwatch::read(std::string what) const {
  const TimeSpent now = spentSoFar();
  return {now.lasted - begin_.lasted, now.computed - begin_.computed, now.queued - begin_.queued,
          std::move(what)};
}

bool TimedApplication::notify(QObject* receiver, QEvent* event) {
  const bool of_window = !in_event_;
  const bool of_panel = !in_panel_ && isOfPanel(receiver);
  if (!of_window && !of_panel) return QApplication::notify(receiver, event);
  // Both may be gone afterwards.
  const QEvent::Type type = event->type();
  const char* name = receiver->metaObject()->className();
  in_event_ = true;
  in_panel_ = in_panel_ || of_panel;
  const Stopwatch watch;
  const bool handled = QApplication::notify(receiver, event);
  const TimeSpent spent = watch.read(nameOf(type) + " of " + name);
  const auto keep = [&](TimeSpent& longest) {
    if (spent.lasted > longest.lasted) longest = spent;
  };
  if (of_window) {
    keep(of_window_);
    in_event_ = false;
  }
  if (of_panel) {
    keep(of_panel_);
    in_panel_ = false;
  }
  return handled;
}

}  // namespace haptex::nodes
