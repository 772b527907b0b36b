#include "haptex/cloth/dynamics/rest_detector.h"

#include <algorithm>
#include <cmath>

namespace haptex::cloth {

void RestDetector::observe(const ClothState& state) {
  if (begun_) {
    for (std::size_t i = 0; i < begin_.size(); ++i) {
      way_squared_ = std::max(way_squared_, (state.positions[i] - begin_[i]).squaredNorm());
    }
    const double seconds = state.time - begin_time_;
    if (++steps_ < kStepsPerWindow || seconds < kWindow) return;
    closeWindow(seconds);
  }
  begun_ = true;
  std::copy(state.positions.begin(), state.positions.end(), begin_.begin());
  begin_time_ = state.time;
  steps_ = 0;
  way_squared_ = 0.0;
}

void RestDetector::closeWindow(double seconds) {
  const double way = std::sqrt(way_squared_);
  // way + way q / (1 - q); without a window before, or if ways grow, there is no end in sight.
  const bool falls = last_way_ && way < *last_way_;
  const bool ends = falls && way / (1.0 - way / *last_way_) < kTolerance;
  const bool quiet = ends || way < kSlowest * seconds;
  quiet_windows_ = quiet ? quiet_windows_ + 1 : 0;
  last_way_ = way;
}

void RestDetector::wake() {
  begun_ = false;
  last_way_.reset();
  quiet_windows_ = 0;
}

bool isUndisturbed(const Cloth& cloth, double time) {
  if (cloth.forces().changesWithTime()) return false;
  return std::all_of(cloth.attachments().begin(), cloth.attachments().end(),
                     [time](const std::optional<AttachmentPath>& path) {
                       return !path || time >= path->start_time + path->duration;
                     });
}

}  // namespace haptex::cloth
