#include "haptex/garment/pattern/seam_reader.h"

#include <algorithm>
#include <string>
#include <utility>

namespace haptex::garment {
namespace {

using base::YamlValue;

int panelOf(const YamlValue& value, const Pattern& pattern) {
  const std::string name = value.text();
  for (std::size_t p = 0; p < pattern.panels.size(); ++p) {
    if (pattern.panels[p].name == name) return static_cast<int>(p);
  }
  value.refuse("is no panel");
}

// By its name or by its number.
int edgeOf(const YamlValue& value, const Outline& outline) {
  const std::string text = value.text();
  for (std::size_t e = 0; e < outline.size(); ++e) {
    if (!outline[e].name.empty() && outline[e].name == text) return static_cast<int>(e);
  }
  const int last = static_cast<int>(outline.size()) - 1;
  const bool number = text.size() <= 6 && text.find_first_not_of("0123456789") == text.npos;
  if (!number || std::stoi(text) > last) {
    value.refuse("is no edge: allowed are names of edges and 0 to " + std::to_string(last));
  }
  return std::stoi(text);
}

// Which outline of the panel: of a hole, or its own.
int outlineOf(const YamlValue& value, const Panel& panel) {
  if (!value.has("hole")) return 0;
  const int hole = value.at("hole").integer();
  const int holes = static_cast<int>(panel.outlines.size()) - 1;
  if (hole < 0 || hole >= holes) {
    value.at("hole").refuse("is no hole: panel '" + panel.name + "' has " + std::to_string(holes));
  }
  return hole + 1;
}

SeamSide readSide(const YamlValue& value, const Pattern& pattern) {
  value.requireKeys({"panel", "edges"}, {"hole", "reversed"});
  SeamSide side;
  side.panel = panelOf(value.at("panel"), pattern);
  const Panel& panel = pattern.panels[side.panel];
  side.outline = outlineOf(value, panel);
  const auto edges = value.at("edges").items();
  if (edges.empty() || edges.size() > 2) {
    value.at("edges").refuse("must be a list of one edge or of the first and the last");
  }
  side.first = edgeOf(edges.front(), panel.outlines[side.outline]);
  side.last = edgeOf(edges.back(), panel.outlines[side.outline]);
  side.reversed = value.has("reversed") && value.at("reversed").oneOf({"true", "false"}) == "true";
  return side;
}

double readEasing(const YamlValue& value) {
  return value.has("easing") ? value.at("easing").number() : kUsualEasing;
}

// A dart is sewn from its tip, the corner in which its two edges meet.
Seam readDart(const YamlValue& value, const Pattern& pattern) {
  value.requireKeys({"panel", "edges"}, {"hole", "easing"});
  const int index = panelOf(value.at("panel"), pattern);
  const Panel& panel = pattern.panels[index];
  const int k = outlineOf(value, panel);
  const Outline& outline = panel.outlines[k];
  const auto edges = value.at("edges").items(2);
  int first = edgeOf(edges[0], outline), second = edgeOf(edges[1], outline);
  const int count = static_cast<int>(outline.size());
  if ((second + 1) % count == first) std::swap(first, second);
  if ((first + 1) % count != second || first == second) {
    value.at("edges").refuse("must be two successive edges, which meet in the tip of the dart");
  }
  Seam dart;
  dart.sides[0] = {index, k, first, first, true};
  dart.sides[1] = {index, k, second, second, false};
  dart.easing = readEasing(value);
  return dart;
}

}  // namespace

void readSeams(const YamlValue& file, Pattern& pattern) {
  if (file.has("seams")) {
    for (const YamlValue& value : file.at("seams").items()) {
      value.requireKeys({"sides"}, {"easing"});
      const auto sides = value.at("sides").items(2);
      Seam seam;
      for (int i = 0; i < 2; ++i) seam.sides[i] = readSide(sides[i], pattern);
      seam.easing = readEasing(value);
      pattern.seams.push_back(seam);
    }
  }
  if (file.has("darts")) {
    for (const YamlValue& value : file.at("darts").items()) {
      pattern.seams.push_back(readDart(value, pattern));
    }
  }
}

void readFastenings(const YamlValue& file, Pattern& pattern) {
  if (!file.has("fasteners")) return;
  for (const YamlValue& value : file.at("fasteners").items()) {
    value.requireKeys({"name", "between"});
    const auto places = value.at("between").items(2);
    Fastening& fastening = pattern.fastenings.emplace_back();
    fastening.name = value.at("name").text();
    for (int i = 0; i < 2; ++i) {
      places[i].requireKeys({"panel", "at"});
      const auto point = places[i].at("at").items(2);
      fastening.places[i] = {panelOf(places[i].at("panel"), pattern),
                             {point[0].number(), point[1].number()}};
    }
  }
}

}  // namespace haptex::garment
