// What is on the wrong side where a cloth intersects itself, and which way it goes out.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "haptex/cloth/dynamics/untangling/contours.h"
#include "haptex/cloth/forces/self_contact/near_pairs.h"

namespace haptex::cloth {

/// The edges that are crossed cut the cloth into regions. Of all that a contour parts, the smallest
/// has gone through the other surface: it is the contour's wrong region, which has to come back.
/// What was wrong in the last find() stays so, as long as it is most of a region.
/// There is none where a contour ends inside of both surfaces, as of two cards that are slotted
/// into each other.
///
/// Allocates nothing once its buffers have had the size that they need.
class TangleRegions {
 public:
  /// @param topology must outlive this
  TangleRegions(const MeshTopology& topology, std::size_t particles);

  /// @param pairs that the contours were found of
  void find(const std::vector<Eigen::Vector3d>& positions,
            const std::vector<proximity::TrianglePair>& pairs,
            const IntersectionContours& contours);

  /// What was wrong.
  void forget();

  /// Unit or zero, of a crossing of the last find(): the way on which its edge goes out of the
  /// tangle against its triangle. Where the contour has a wrong region it is the normal of the
  /// surface through which that goes back; the contour's gradient (Crossing::shorter), summed over
  /// all of it, where it has none.
  const Eigen::Vector3d& wayOut(std::size_t crossing) const { return ways_[crossing]; }

  /// Which particles are on which side of contours: those within two edges of a crossing, and all
  /// of wrong regions and of the other side as far around as these are deep.
  const TangleSides& sides() const { return sides_; }

 private:
  void cutIntoRegions(const std::vector<Crossing>& crossings);
  void chooseWrong(const IntersectionContours& contours);
  bool isMoreWrong(int region, int other) const;
  Eigen::Vector3d wayBack(const std::vector<Eigen::Vector3d>& positions,
                          const Crossing& crossing) const;
  void markSides(const std::vector<proximity::TrianglePair>& pairs,
                 const IntersectionContours& contours);
  int spread(int stamp, int rings, int within, std::vector<std::uint64_t>& side);

  const MeshTopology& topology_;
  std::vector<char> cut_;          // of an edge
  std::vector<int> region_of_;     // of a particle
  std::vector<int> sizes_;         // particles of a region
  std::vector<int> wrong_before_;  // of these, that were wrong in the last find()
  std::vector<char> was_wrong_;    // of a particle
  std::vector<int> wrong_;         // region, of a contour; -1: none
  std::vector<char> wrong_on_first_;
  std::vector<Eigen::Vector3d> ways_, of_contour_;
  TangleSides sides_;
  std::vector<int> order_;  // of pairs, by contour
  std::vector<int> reached_, front_, next_;
};

}  // namespace haptex::cloth
