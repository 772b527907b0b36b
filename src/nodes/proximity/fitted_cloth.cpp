#include "haptex/nodes/proximity/fitted_cloth.h"

#include <chrono>
#include <limits>
#include <mutex>
#include <utility>

namespace haptex::nodes {

FittedCloth::FittedCloth(RestMesh mesh)
    : mesh_(std::move(mesh)), hierarchy_(mesh_.triangles, mesh_.rest_coordinates) {}

FittedCloth::View FittedCloth::look(const ArrivedState& state) {
  double refit_seconds = std::numeric_limits<double>::quiet_NaN();
  std::shared_lock<std::shared_mutex> lock(mutex_);
  if (fitted_.number < state.number) {
    lock.unlock();
    refit_seconds = refit(state);
    lock.lock();
  }
  return {std::move(lock), hierarchy_, *fitted_.message, refit_seconds};
}

/// @returns its computing time (s), NaN if another thread was faster
double FittedCloth::refit(const ArrivedState& state) {
  const std::unique_lock<std::shared_mutex> lock(mutex_);
  if (fitted_.number >= state.number) return std::numeric_limits<double>::quiet_NaN();
  const auto begin = std::chrono::steady_clock::now();
  positions_.resize(state.message->positions.size());
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    const geometry_msgs::Point& position = state.message->positions[i];
    positions_[i] = {position.x, position.y, position.z};
  }
  hierarchy_.refit(positions_);
  fitted_ = state;
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace haptex::nodes
