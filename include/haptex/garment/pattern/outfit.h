// Several garments that are worn at the same time, as one pattern.
#pragma once

#include <string>

#include "haptex/garment/pattern/pattern.h"

namespace haptex::garment {

constexpr std::size_t kMostGarments = 8;

/// Of a garment file what loadPattern() reads; of a list of garments, a file with the key garments,
/// the panels, carriers and seams of all in the order of dressing: the layers of each lie outside
/// of all layers of those before it. Names of panels and carriers get that of their garment and a
/// '/' in front. The list has names of garment files beside it, without .yaml, or paths.
/// Blanks and control characters in the names of panels become '_': groups of OBJ files have none.
/// @throws std::runtime_error as loadPattern()
/// @throws std::invalid_argument as loadPattern(), and naming file, key, value and what is allowed
///   if there is no garment, more than kMostGarments or one twice, one of them is a list itself, or
///   they have too many layers, or two panels have the same name
Pattern loadOutfit(const std::string& path);

}  // namespace haptex::garment
