// Which elements of the large-scale mesh make up the patch.
#pragma once

#include <vector>

#include "haptex/contact/fingertip.h"
#include "haptex/contact/haptic_settings.h"
#include "haptex/contact/refined_cut.h"

namespace haptex::contact {

/// Where to look for the elements of a patch: the nearest `count` within `distance` of the capsule
/// from `begin` to `end` with `radius` (m, world frame).
struct SearchVolume {
  Eigen::Vector3d begin;
  Eigen::Vector3d end;
  double radius;
  double distance;
  std::size_t count;
};

/// Around the fingertip now and, if settings.predict, `seconds` later.
SearchVolume searchVolume(const Fingertip& fingertip, double seconds,
                          const HapticSettings& settings);

/// An element comes in when it is within the margin of a fingertip and one of the most_elements
/// nearest. It goes out when it is farther from both fingertips than the margin and kHysteresis, or
/// there are a quarter more elements that are nearer and it has not touched for kRests rounds: a
/// fingertip at rest, or cloth that folds around it, does not make the patch change to and fro.
/// What a fingertip pushes off needs so long to fall back. At twice most_elements that are nearer
/// it goes out in any case.
class PatchSelection {
 public:
  static constexpr double kHysteresis = 4e-3;  ///< m
  static constexpr double kTouching = 2e-3;    ///< m, less is taken for contact
  static constexpr int kRests = 32;            ///< rounds: 0.4 s of states at 80 Hz

  /// @param elements of the large-scale mesh
  explicit PatchSelection(std::size_t elements)
      : chosen_(elements, 0), wanted_(elements, 0), apart_(elements, kRests) {}

  // One round: begin(), keep() for what a fingertip touches, add() for everything that a query of
  // searchVolume() found, finish().
  void begin();
  /// An element that a fingertip touches in the patch stays, wherever the large-scale cloth has it.
  /// Nothing else comes in by this.
  void keep(int element);
  /// @param element  in [0, elements)
  /// @param distance m, from the search volume
  /// @param rank     how many are nearer to this fingertip
  void add(int element, double distance, int rank, const HapticSettings& settings);
  /// @returns whether the selection has changed since the last round
  bool finish();

  /// Ascending.
  const std::vector<int>& elements() const { return elements_; }

 private:
  std::vector<char> chosen_;
  std::vector<char> wanted_;
  std::vector<int> apart_;  // rounds since an element touched, kRests at most
  std::vector<int> elements_;
};

/// What a patch has around its refined elements, nearest first: at most 400, and at most a quarter
/// of the mesh, so that the large-scale cloth holds the patch.
/// @param elements each once
/// @param reach m, how far, >= 0
std::vector<int> elementsAround(const mesh::ClothMesh& mesh, const MeshTopology& topology,
                                const std::vector<int>& elements, double reach);

}  // namespace haptex::contact
