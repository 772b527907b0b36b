#include "timed_application.h"

#include <QElapsedTimer>
#include <QMetaEnum>
#include <ctime>

#include "haptex/nodes/rviz_plugin/panel.h"

namespace haptex::nodes {
namespace {

/// ms of a processor, by this thread
double computedTime() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
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

bool TimedApplication::notify(QObject* receiver, QEvent* event) {
  const bool of_window = !in_event_;
  const bool of_panel = !in_panel_ && isOfPanel(receiver);
  if (!of_window && !of_panel) return QApplication::notify(receiver, event);
  // Both may be gone afterwards.
  const QEvent::Type type = event->type();
  const char* name = receiver->metaObject()->className();
  in_event_ = true;
  in_panel_ = in_panel_ || of_panel;
  QElapsedTimer timer;
  timer.start();
  const double begin = computedTime();
  const bool handled = QApplication::notify(receiver, event);
  const double lasted = 1e-6 * static_cast<double>(timer.nsecsElapsed());
  const double computed = computedTime() - begin;
  const auto keep = [&](EventTime& longest) {
    if (lasted > longest.lasted) longest = {lasted, computed, nameOf(type) + " of " + name};
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
