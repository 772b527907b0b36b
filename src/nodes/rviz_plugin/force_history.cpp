#include "haptex/nodes/rviz_plugin/force_history.h"

#include <QPainter>
#include <algorithm>
#include <cmath>

namespace haptex::nodes {
namespace {

constexpr int kTop = 16, kBottom = 4, kLeft = 4;  // pixels
constexpr double kSmallestScale = 0.1;            // N, of the whole height

/// As the targets of the fingers are coloured in rviz.
QColor colourOf(base::Finger finger) {
  return finger == base::Finger::kIndex ? QColor(204, 92, 26) : QColor(26, 115, 191);
}

}  // namespace

ForceHistory::ForceHistory(QWidget* parent) : QWidget(parent) {
  setMinimumHeight(110);
  setToolTip(
      "Forces on the fingertips: full what the device measures, dashed what the cloth gives");
}

void ForceHistory::add(base::Time now) {
  samples_.push_back({now, newest_});
  while (now - samples_.front().time > kSpan) samples_.pop_front();
  update();
}

double ForceHistory::largest() const {
  double largest = kSmallestScale;
  for (const Sample& sample : samples_) {
    for (const Forces& forces : sample.forces.values) {
      for (const double force : {forces.measured, forces.computed}) {
        if (std::isfinite(force)) largest = std::max(largest, force);
      }
    }
  }
  return largest;
}

void ForceHistory::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  painter.fillRect(rect(), Qt::white);
  painter.setPen(QColor(190, 190, 190));
  painter.drawRect(rect().adjusted(0, 0, -1, -1));
  const double scale = largest();
  painter.setPen(Qt::black);
  painter.drawText(kLeft, kTop - 4, QString("0 to %1 N, 10 s").arg(scale, 0, 'g', 2));
  int right = width() - kLeft;
  for (const base::Finger finger : {base::Finger::kThumb, base::Finger::kIndex}) {
    const QString name = base::name(finger);
    right -= painter.fontMetrics().horizontalAdvance(name);
    painter.setPen(colourOf(finger));
    painter.drawText(right, kTop - 4, name);
    right -= 8;
  }
  if (samples_.empty()) return;
  const base::Time end = samples_.back().time;
  for (const base::Finger finger : base::kFingers) {
    for (const bool measured : {false, true}) {
      QPolygonF curve;
      for (const Sample& sample : samples_) {
        const Forces& forces = sample.forces[finger];
        const double force = measured ? forces.measured : forces.computed;
        if (!std::isfinite(force)) continue;
        const double across = 1.0 - base::seconds(end - sample.time) / base::seconds(kSpan);
        curve << QPointF(across * width(),
                         height() - kBottom - force / scale * (height() - kTop - kBottom));
      }
      painter.setPen(QPen(colourOf(finger), 1.5, measured ? Qt::SolidLine : Qt::DashLine));
      painter.drawPolyline(curve);
    }
  }
}

}  // namespace haptex::nodes
