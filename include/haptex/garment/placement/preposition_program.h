// What the program preposition does.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

namespace haptex::garment {

/// `GARMENT.yaml BODY.yaml OUT.obj [--edge METRES] [--body BODY.obj]`: lays a garment's panels
/// around a body and writes them as OBJ, each a group, with rest coordinates as texture
/// coordinates; and, if asked to, the body's surface. Prints a line per panel that was laid on a
/// carrier and one per pair of panels that intersect, or a panel and the body, on `out`; what is
/// refused, on `err`.
/// @return exit status: 0, 1 if a file was refused, 2 if the arguments were, 3 if something
///   intersects
int prepositionProgram(const std::vector<std::string>& arguments, std::ostream& out,
                       std::ostream& err);

}  // namespace haptex::garment
