// Garments from disturbed starts as a study in parts.
#pragma once

#include <string>
#include <vector>

#include "haptex/studies/jobs/study.h"

namespace haptex::studies {

struct GarmentSettings {
  std::size_t starts = 0;  ///< of each garment, > 0
  unsigned seed = 1;       ///< of disturb(), of the first; the others follow
  std::string config;      ///< the directory of the package's files
};

/// A unit is a start of a garment, garments in turn (garmentScenes()). Its record has, with tabs
/// between: garment and seed; whether it came to rest as 0 or 1; time to sew it and to rest, s; how
/// many states intersected themselves; pairs of triangles that intersect at the end, with itself
/// and with the body; and of one that was not sewn, why, with 0 for all numbers.
class GarmentStudy final : public Study {
 public:
  /// @throws std::invalid_argument without starts, or with so many that seeds end
  explicit GarmentStudy(GarmentSettings settings);

  std::string name() const override { return "garments"; }
  std::size_t unitCount() const override;
  /// With a checksum of all files of the directory.
  StudyInputs inputs() const override;
  std::string run(std::size_t unit) const override;
  /// Of each garment: how many starts came to rest without an intersection, in any state or at the
  /// end, and the most pairs at the end; and the starts that did not.
  void summarise(const std::vector<std::string>& records, std::ostream& out) const override;

 private:
  GarmentSettings settings_;
};

}  // namespace haptex::studies
