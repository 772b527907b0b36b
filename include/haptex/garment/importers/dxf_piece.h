// A piece of a sewing pattern as a DXF block draws it.
#pragma once

#include <string>
#include <vector>

#include "haptex/garment/importers/dxf_reader.h"
#include "haptex/garment/pattern/pattern.h"

namespace haptex::garment {

/// Makes a panel of a block.
/// @param where in messages, before what is wrong @param metre per unit of the drawing
/// @param notes added to
/// @throws std::invalid_argument
Panel readPiece(const DxfBlock& block, const std::string& where, double metre,
                std::vector<std::string>& notes);

/// Whether a block has an outline.
bool isPiece(const DxfBlock& block);

/// What stands behind "Key:" in a text of a block, in any case of letters; empty if nothing does.
std::string systemText(const std::vector<DxfEntity>& entities, const std::string& key);

}  // namespace haptex::garment
