// What the contactors under both fingertips do.
#pragma once

#include <haptex/Tactile.h>

#include <QWidget>
#include <array>

#include "haptex/base/finger.h"

namespace haptex::nodes {

/// Heat maps of 40 Hz and 320 Hz of each array, on the scale of amplitudeFraction(), with
/// the largest amplitude of each in um; the fingertip points upwards. By Qt's thread.
class ArrayView : public QWidget {
 public:
  explicit ArrayView(QWidget* parent = nullptr);

  void show(base::Finger finger, const haptex::Tactile& tactile);

  QSize sizeHint() const override { return {240, 118}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  base::PerFinger<haptex::Tactile> tactile_;
};

}  // namespace haptex::nodes
