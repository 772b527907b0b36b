// What the program import_pattern does.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

namespace haptex::garment {

/// `FILE OUT.yaml [--fabric NAME]`: makes a garment file of a pattern in JSON (GarmentCode) or DXF,
/// by the extension of its name. Seams of `x.dxf` are in `x.seams.yaml` beside it, if that is
/// there. Prints a line per panel with edges and area, and one per seam with both lengths, on
/// `out`; what is refused, on `err`.
/// @return exit status: 0, 1 if the file was refused, 2 if the arguments were
int importPattern(const std::vector<std::string>& arguments, std::ostream& out, std::ostream& err);

}  // namespace haptex::garment
