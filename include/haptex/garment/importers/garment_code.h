// Patterns of GarmentCode and NeuralTailor (JSON).
#pragma once

#include <string>

#include "haptex/garment/pattern/pattern.h"

namespace haptex::garment {

/// The pattern of a specification of GarmentCode (Korosteleva and Sorkine-Hornung, GarmentCode:
/// Programming Parametric Sewing Patterns, 2023) or of the format before it, NeuralTailor's.
///
/// Lengths are in metres afterwards, by the file's `units_in_meter` (100 where it says nothing).
/// GarmentCode's axes are x to the left of the body, y up, z forward; those of the world are x
/// forward, y to the left, z up. A panel's own axes stay as they are, its grain is along y.
///
/// Stitches do not say which ends meet. One that is marked "right_wrong" joins the starts of its
/// edges. The others join the end of one edge and the start of the other, as the format's own tools
/// do, unless the panels are placed otherwise: oppositeEndsMeet(). Lengths may differ as they do in
/// the file: by that the easing is set.
///
/// @param text of the file @param name of it in messages
/// @param fabric for all panels: these files know none
/// @throws std::invalid_argument naming file, panel, edge, the value and what is allowed
Pattern importGarmentCode(const std::string& text, const std::string& name,
                          const std::string& fabric);

}  // namespace haptex::garment
