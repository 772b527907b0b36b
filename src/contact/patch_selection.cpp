#include "haptex/contact/patch_selection.h"

#include <algorithm>

namespace haptex::contact {
namespace {

constexpr std::size_t kMostAround = 400;  // what a millisecond leaves time for
constexpr std::size_t kShareOfMesh = 4;   // one of so many elements

}  // namespace

SearchVolume searchVolume(const Fingertip& fingertip, double seconds,
                          const HapticSettings& settings) {
  const Eigen::Vector3d end =
      settings.predict ? predict(fingertip, seconds).position : fingertip.position;
  return {fingertip.position, end, fingertip.radius, settings.margin + PatchSelection::kHysteresis,
          static_cast<std::size_t>(2 * settings.most_elements)};
}

void PatchSelection::begin() {
  std::fill(wanted_.begin(), wanted_.end(), 0);
  for (int& rounds : apart_) rounds = std::min(rounds + 1, kRests);
}

void PatchSelection::keep(int element) {
  const bool exists = element >= 0 && element < static_cast<int>(chosen_.size());
  if (!exists || !chosen_[element]) return;
  apart_[element] = 0;
  wanted_[element] = 1;
}

void PatchSelection::add(int element, double distance, int rank, const HapticSettings& settings) {
  const bool stays = chosen_[element];
  const double reach = settings.margin + (stays ? kHysteresis : 0.0);
  const int most = settings.most_elements + (stays ? settings.most_elements / 4 : 0);
  if (distance <= kTouching) apart_[element] = 0;
  if (distance <= reach && (rank < most || (stays && apart_[element] < kRests))) {
    wanted_[element] = 1;
  }
}

bool PatchSelection::finish() {
  if (wanted_ == chosen_) return false;
  std::swap(wanted_, chosen_);
  elements_.clear();
  for (std::size_t i = 0; i < chosen_.size(); ++i) {
    if (chosen_[i]) elements_.push_back(static_cast<int>(i));
  }
  return true;
}

std::vector<int> elementsAround(const mesh::ClothMesh& mesh, const MeshTopology& topology,
                                const std::vector<int>& elements, double reach) {
  return trianglesAround(mesh, topology, elements, reach,
                         std::min(kMostAround, mesh.triangles.size() / kShareOfMesh));
}

}  // namespace haptex::contact
