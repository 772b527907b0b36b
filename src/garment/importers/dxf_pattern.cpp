#include "haptex/garment/importers/dxf_pattern.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <utility>

#include "haptex/base/require.h"
#include "haptex/base/yaml_reader.h"
#include "haptex/garment/importers/dxf_piece.h"
#include "haptex/garment/importers/dxf_reader.h"
#include "haptex/garment/pattern/seam_reader.h"

namespace haptex::garment {
namespace {

using base::refuse;
using base::YamlValue;

double metreOf(const std::string& unit) {
  if (unit == "mm") return 0.001;
  if (unit == "cm") return 0.01;
  return unit == "m" ? 1.0 : 0.0254;
}

// What a text of the whole style says, which may stand in a block.
std::string styleText(const DxfDrawing& drawing, const std::string& key) {
  std::string text = systemText(drawing.entities, key);
  for (const DxfBlock& block : drawing.blocks) {
    if (text.empty()) text = systemText(block.entities, key);
  }
  return text;
}

// As the style's text "Units: METRIC" or "Units: ENGLISH" says it, or the header.
double metreOf(const DxfDrawing& drawing, const std::string& name) {
  std::string units = styleText(drawing, "Units");
  for (char& c : units) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  if (units == "METRIC") return metreOf("mm");
  if (units == "ENGLISH") return metreOf("inch");
  switch (drawing.unit) {
    case 1:
      return metreOf("inch");
    case 4:
      return metreOf("mm");
    case 5:
      return metreOf("cm");
    case 6:
      return metreOf("m");
    default:
      refuse(name, ": does not say its unit ('", units.substr(0, 40), "', $INSUNITS ", drawing.unit,
             "): a sidecar with unit: mm, cm, m or inch must");
  }
}

// Names of panels, of ASCII letters that files and terminals agree on.
std::string plain(std::string text) {
  for (char& c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x20 || code > 0x7e) c = '_';
  }
  return text.substr(0, 200);
}

// Those of one size, if there are pieces of that size; all otherwise.
std::vector<const DxfBlock*> piecesOf(const DxfDrawing& drawing, const std::string& size,
                                      const std::string& name, std::vector<std::string>& notes) {
  std::vector<const DxfBlock*> all, sized;
  for (const DxfBlock& block : drawing.blocks) {
    if (!isPiece(block)) continue;
    all.push_back(&block);
    if (!size.empty() && systemText(block.entities, "Size") == size) sized.push_back(&block);
  }
  if (sized.empty() || sized.size() == all.size()) return all;
  notes.push_back(name + ": " + std::to_string(all.size() - sized.size()) +
                  " pieces of other sizes than " + plain(size) + " are left out");
  return sized;
}

// The piece's own name, if it is the only one of this name; the block's otherwise.
void namePanels(const std::vector<const DxfBlock*>& blocks, Pattern& pattern) {
  std::vector<std::string> names;
  for (const DxfBlock* block : blocks)
    names.push_back(plain(systemText(block->entities, "Piece Name")));
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const bool unique = std::count(names.begin(), names.end(), names[i]) == 1;
    pattern.panels[i].name = unique && !names[i].empty() ? names[i] : plain(blocks[i]->name);
  }
}

}  // namespace

ImportedPattern importDxf(const std::string& text, const std::string& name,
                          const std::string& sidecar, const std::string& sidecar_name,
                          const std::string& fabric) {
  ImportedPattern imported;
  Pattern& pattern = imported.pattern;
  pattern.source = name;
  const DxfDrawing drawing = readDxf(text, name);
  const auto said =
      sidecar.empty() ? std::nullopt : std::make_optional(YamlValue::parse(sidecar, sidecar_name));
  if (said) said->requireKeys({}, {"unit", "size", "seams", "darts"});
  const double metre = said && said->has("unit")
                           ? metreOf(said->at("unit").oneOf({"mm", "cm", "m", "inch"}))
                           : metreOf(drawing, name);
  const std::string size =
      said && said->has("size") ? said->at("size").text() : styleText(drawing, "Sample Size");
  std::vector<const DxfBlock*> pieces;
  for (const DxfBlock* piece : piecesOf(drawing, size, name, imported.notes)) {
    const DxfBlock& block = *piece;
    const std::string where = name + ": piece '" + plain(block.name) + "'";
    if (pieces.size() == kMostPanels) refuse(where, ": allowed are up to ", kMostPanels, " pieces");
    pieces.push_back(piece);
    pattern.panels.push_back(readPiece(block, where, metre, imported.notes));
    pattern.panels.back().fabric = fabric;
    const std::string quantity = systemText(block.entities, "Quantity");
    if (!quantity.empty() && quantity != "1") {
      imported.notes.push_back(where + ": is cut " + plain(quantity) + " times: one panel is made");
    }
  }
  namePanels(pieces, pattern);
  requireSound(pattern, name);
  if (said) {
    readSeams(*said, pattern);
    requireSound(pattern, sidecar_name);
  }
  return imported;
}

}  // namespace haptex::garment
