// The program drape_garment: docs/garments.md describes it.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

namespace haptex::dressing {

/// @param arguments GARMENT.yaml OUT.obj --body BODY.obj|BODY.yaml [--edge METRES]
///   [--scene SCENE.yaml]; panels on carriers need a BODY.yaml
/// @param fabric_directory where fabrics lie that are not in `fabrics` beside the garment's
///   directory
/// @param out lines of a name, a value and a unit, with tabs between; `err` for refusals
/// @returns the exit status: 0 if the garment is at rest and intersects neither itself nor the
/// body,
///   1 if it does not or something was refused, 2 if the arguments were
int drapeGarment(const std::vector<std::string>& arguments, const std::string& fabric_directory,
                 std::ostream& out, std::ostream& err);

}  // namespace haptex::dressing
