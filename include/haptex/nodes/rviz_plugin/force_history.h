// The forces of the last seconds as curves.
#pragma once

#include <QWidget>
#include <deque>

#include "haptex/base/clock.h"
#include "haptex/base/finger.h"

namespace haptex::nodes {

/// Of each finger what is measured (full line) and what the cloth gives (dashed), over kSpan. By
/// Qt's thread.
class ForceHistory : public QWidget {
 public:
  static constexpr base::Time kSpan = std::chrono::seconds(10);

  explicit ForceHistory(QWidget* parent = nullptr);

  /// The newest values, which the next add() takes. @param force N
  void setComputed(base::Finger finger, double force) { newest_[finger].computed = force; }
  void setMeasured(base::Finger finger, double force) { newest_[finger].measured = force; }
  /// A point of the curves. @param now of a steady clock
  void add(base::Time now);

  QSize sizeHint() const override { return {240, 110}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  struct Forces {
    double measured = 0.0, computed = 0.0;  // N
  };
  struct Sample {
    base::Time time;
    base::PerFinger<Forces> forces;
  };

  double largest() const;

  base::PerFinger<Forces> newest_;
  std::deque<Sample> samples_;
};

}  // namespace haptex::nodes
