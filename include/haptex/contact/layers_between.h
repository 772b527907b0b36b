// How many layers of folded cloth lie between the particles of a patch and two fingertips that
// pinch it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "haptex/contact/fingertip.h"
#include "haptex/contact/large_scale_motion.h"
#include "haptex/contact/refined_cut.h"

namespace haptex::contact {

/// The layers of a pinch are springs in series: the same pressure goes through all, and their
/// compressed thicknesses add up. A particle with k layers between it and a fingertip is pushed by
/// it through (k + 1/2) thicknesses of fabric (ContactLaw::pressureThrough()), and the n layers of
/// a stack share the pressure evenly: each of them has an nth of its area in contact. So
/// the fingertips together feel the pressure once, at n times the thickness that it gives a layer,
/// and every layer is where it is in a stack.
///
/// Layers are counted along the straight line from the particle's place on the large-scale cloth to
/// the fingertip's centre, through the elements of the large-scale mesh that the patch was cut
/// from. A layer counts whole if it is at most 1.5 thicknesses beyond the one before, and less and
/// less up to 2.5. Every kRounds milliseconds a particle is counted anew, and what it has follows
/// within kFade: forces do not jump.
///
/// The constructor does all that needs memory.
class LayersBetween {
 public:
  static constexpr int kMost = 8;        ///< layers that a stack may have
  static constexpr int kRounds = 32;     ///< steps from one count of a particle to the next
  static constexpr double kFade = 0.02;  ///< s, to 1/e

  /// @param coarse    the mesh that was cut
  /// @param thickness m, of the thickest fabric without pressure, > 0
  /// @param areas     m^2, at rest, per particle
  LayersBetween(const mesh::ClothMesh& coarse, const RefinedCut& cut, double thickness,
                std::vector<double> areas);

  /// One layer everywhere.
  void clear();
  /// Takes over what another patch has of a particle.
  void adopt(int particle, const LayersBetween& other, int other_particle);

  /// One step, in which only fingertips that are both present and less than kMost thicknesses apart
  /// pinch anything, and only what is between them.
  /// @param fingertips null: absent
  /// @param h s
  void update(const LargeScaleMotion& motion, const base::PerFinger<const Fingertip*>& fingertips,
              double h);

  /// Layers between each particle and the fingertip, >= 0.
  const std::vector<double>& before(base::Finger finger) const { return before_[finger]; }
  /// Each particle's area at rest over the number of layers (m^2).
  const std::vector<double>& areas() const { return shared_areas_; }
  /// Whether there is one layer everywhere.
  bool isSingle() const { return is_single_; }

 private:
  /// Of the elements that were cut, by their own numbers.
  struct Triangle {
    int element;  ///< of the large-scale mesh
    std::array<int, 3> corners;
  };

  void place(const LargeScaleMotion& motion);
  void countAll(const base::PerFinger<const Fingertip*>& fingertips);
  double count(int particle, const Eigen::Vector3d& from, const Eigen::Vector3d& centre);

  double thickness_;                     // m
  int free_count_;                       // of the cut
  std::vector<double> areas_;            // m^2
  std::vector<int> vertices_;            // of the large-scale mesh
  std::vector<Eigen::Vector3d> places_;  // m, theirs
  std::vector<Triangle> triangles_;
  std::vector<int> owners_;               // per particle, into triangles_
  std::vector<Eigen::Vector3d> weights_;  // per particle, of its owner's corners
  std::vector<double> crossings_;         // m, distances on a line, ascending
  base::PerFinger<std::vector<double>> before_, targets_;
  std::vector<double> shared_areas_;  // m^2
  int round_ = 0;
  bool is_single_ = true;
  bool is_counted_ = false;  // some target is not 0
};

}  // namespace haptex::contact
