// Patterns in DXF files of AAMA and ASTM D6673.
#pragma once

#include <string>
#include <vector>

#include "haptex/garment/pattern/pattern.h"

namespace haptex::garment {

struct ImportedPattern {
  Pattern pattern;
  std::vector<std::string> notes;  ///< what the file has and the pattern has not, for a person
};

/// One panel per block that has an outline, with lengths in metres; if the file or its sidecar
/// names a sample size, those of that size. Of the layers of ASTM D6673: 1 the outline, or 14 if
/// that is one closed sew line, as one polyline or several lines that follow each other; where
/// these meet, at 2 turn points and 4 notches the outline is divided into edges, in the absence of
/// turn points at corners of more than 30 degrees at which no curve point (3) lies; 6 a mirror line
/// along the outline, at which a half piece is unfolded; 7 the grain; 8 and 13 lines and drill
/// holes, the panel's marks; 11 holes. All panels lie where they are drawn, as if on a table: from
/// above one sees their right side.
///
/// These files know neither seams nor, if they are older, their unit; a sidecar says it: a YAML
/// text with `unit` (mm, cm, m, inch), `size`, `seams` and `darts` as in garment files, each
/// optional.
///
/// @param text of the DXF file @param name of it in messages
/// @param sidecar its text, or an empty one @param sidecar_name of it in messages
/// @param fabric for all panels
/// @throws std::invalid_argument naming file, piece, layer or edge, the value and what is allowed
/// @throws std::runtime_error naming the sidecar and the line if it is not YAML
ImportedPattern importDxf(const std::string& text, const std::string& name,
                          const std::string& sidecar, const std::string& sidecar_name,
                          const std::string& fabric);

}  // namespace haptex::garment
