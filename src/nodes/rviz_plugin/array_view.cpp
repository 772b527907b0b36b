#include "haptex/nodes/rviz_plugin/array_view.h"

#include <QPainter>
#include <algorithm>

#include "haptex/nodes/markers/colour_map.h"
#include "haptex/nodes/tactile_renderer/tactile_markers.h"
#include "haptex/tactile/channels.h"
#include "haptex/tactile/contactor_array.h"

namespace haptex::nodes {
namespace {

using base::Finger;
using tactile::Channel;

constexpr int kCell = 11, kText = 32, kGap = 8;  // pixels

const haptex::Tactile::_amplitudes_40_type& amplitudesOf(const haptex::Tactile& tactile,
                                                         Channel channel) {
  return channel == tactile::k40 ? tactile.amplitudes_40 : tactile.amplitudes_320;
}

/// x of the array is upwards and y to the left, as its owner sees it who looks at the pad.
void paintArray(QPainter& painter, int left, Channel channel, const haptex::Tactile& tactile) {
  const auto& amplitudes = amplitudesOf(tactile, channel);
  for (int i = 0; i < tactile::kContactors; ++i) {
    const int column = i % tactile::kContactorColumns, row = i / tactile::kContactorColumns;
    const Eigen::Vector3f colour =
        viridis(amplitudeFraction(channel, amplitudes[static_cast<std::size_t>(i)]));
    painter.fillRect(left + (tactile::kContactorRows - 1 - row) * kCell,
                     kText + (tactile::kContactorColumns - 1 - column) * kCell, kCell - 1,
                     kCell - 1, QColor::fromRgbF(colour[0], colour[1], colour[2]));
  }
}

}  // namespace

ArrayView::ArrayView(QWidget* parent) : QWidget(parent) {
  setMinimumHeight(kText + tactile::kContactorColumns * kCell + 4);
}

void ArrayView::show(Finger finger, const haptex::Tactile& tactile) {
  tactile_[finger] = tactile;
  update();
}

void ArrayView::paintEvent(QPaintEvent* /*event*/) {
  QPainter painter(this);
  const int step = std::max(tactile::kContactorRows * kCell + kGap, (width() - kGap) / 4);
  int left = 2;
  for (const Finger finger : base::kFingers) {
    for (const Channel channel : {tactile::k40, tactile::k320}) {
      const auto& amplitudes = amplitudesOf(tactile_[finger], channel);
      const double largest = *std::max_element(amplitudes.begin(), amplitudes.end());
      painter.drawText(
          left, 12,
          QString("%1 %2").arg(base::name(finger), channel == tactile::k40 ? "40" : "320"));
      painter.drawText(left, 26, QString("%1 um").arg(largest, 0, 'f', 1));
      paintArray(painter, left, channel, tactile_[finger]);
      left += step;
    }
  }
}

}  // namespace haptex::nodes
