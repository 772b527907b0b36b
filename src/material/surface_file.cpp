#include "haptex/material/surface_file.h"

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

namespace haptex::material {
namespace {

std::string written(double number) {
  std::ostringstream text;
  text << number;
  return text.str();
}

std::string written(const Colour& colour) {
  return "[" + written(colour[0]) + ", " + written(colour[1]) + ", " + written(colour[2]) + "]";
}

double readFromTo(const base::YamlValue& value, double least, double most,
                  const std::string& unit = "") {
  const double number = value.number();
  if (number < least || number > most) {
    value.refuse("must be from " + written(least) + " to " + written(most) + unit);
  }
  return number;
}

double readPositiveUpTo(const base::YamlValue& value, double most, const std::string& unit) {
  const double number = value.number();
  if (number <= 0.0 || number > most) {
    value.refuse("must be > 0 and at most " + written(most) + unit);
  }
  return number;
}

Yarns readYarns(const base::YamlValue& value) {
  value.requireKeys({"spacing", "height"});
  return {readFromTo(value.at("spacing"), kMinYarnSpacing, kMaxYarnSpacing, " m"),
          readFromTo(value.at("height"), 0.0, kMaxYarnHeight, " m")};
}

WeaveKind readWeaveKind(const base::YamlValue& value) {
  const std::string kind = value.oneOf({"plain", "twill_2_2", "twill_3_1", "satin_5", "rib_2"});
  if (kind == "plain") return WeaveKind::kPlain;
  if (kind == "twill_2_2") return WeaveKind::kTwill22;
  if (kind == "twill_3_1") return WeaveKind::kTwill31;
  if (kind == "satin_5") return WeaveKind::kSatin5;
  return WeaveKind::kRib2;
}

Weave readWeave(const base::YamlValue& value) {
  value.requireKeys({"unit", "provenance", "source", "kind", "weft", "warp", "irregularity"});
  value.at("unit").oneOf({"m"});
  const Weave weave{readWeaveKind(value.at("kind")), readYarns(value.at("weft")),
                    readYarns(value.at("warp")),
                    readFromTo(value.at("irregularity"), 0.0, kMaxIrregularity)};
  if (weave.weft.height == 0.0 && weave.warp.height == 0.0) {
    value.refuseBecause("the height of weft or warp must be > 0: the relief is flat");
  }
  return weave;
}

Knit readKnit(const base::YamlValue& value) {
  value.requireKeys({"unit", "provenance", "source", "wale", "course", "irregularity"});
  value.at("unit").oneOf({"m"});
  return {readFromTo(value.at("wale"), kMinLoopSpacing, kMaxLoopSpacing, " m"),
          readFromTo(value.at("course"), kMinLoopSpacing, kMaxLoopSpacing, " m"),
          readFromTo(value.at("irregularity"), 0.0, kMaxIrregularity)};
}

HeightFile readHeightFile(const base::YamlValue& value) {
  value.requireKeys({"unit", "provenance", "source", "file", "spacing", "height", "periodic"});
  value.at("unit").oneOf({"m"});
  const std::filesystem::path file = value.at("file").text();
  if (file.extension() != ".png" && file.extension() != ".raw") {
    value.at("file").refuse("must end in .png or .raw");
  }
  return {(std::filesystem::path(value.file()).parent_path() / file).string(),
          readPositiveUpTo(value.at("spacing"), kMaxSampleSpacing, " m"),
          readPositiveUpTo(value.at("height"), kMaxFieldHeight, " m"),
          value.at("periodic").oneOf({"true", "false"}) == "true"};
}

Colour readColour(const base::YamlValue& value) {
  const std::vector<base::YamlValue> shares = value.items(3);
  return {readFromTo(shares[0], 0.0, 1.0), readFromTo(shares[1], 0.0, 1.0),
          readFromTo(shares[2], 0.0, 1.0)};
}

}  // namespace

Surface readSurface(const base::YamlValue& value, double friction) {
  value.requireKeys({"kes"}, {"weave", "knit", "heights"});
  if (value.has("weave") + value.has("knit") + value.has("heights") != 1) {
    value.refuseBecause("must have exactly one of weave, knit, heights");
  }
  const base::YamlValue kes = value.at("kes");
  kes.requireKeys({"unit", "provenance", "source", "SMD", "MMD"});
  kes.at("unit").oneOf({"m"});
  Surface surface;
  surface.roughness = readPositiveUpTo(kes.at("SMD"), kMaxRoughness, " m");
  surface.friction_deviation = readFromTo(kes.at("MMD"), 0.0, 1.0);
  if (surface.friction_deviation > friction) {
    kes.at("MMD").refuse("must be at most the coefficient of friction, " + written(friction));
  }
  if (value.has("weave")) {
    surface.relief = readWeave(value.at("weave"));
  } else if (value.has("knit")) {
    surface.relief = readKnit(value.at("knit"));
  } else {
    surface.relief = readHeightFile(value.at("heights"));
  }
  return surface;
}

Look readLook(const base::YamlValue& value, bool knitted) {
  value.requireKeys({"provenance", "source", "warp", "weft", "gloss", "width"});
  const Look look{readColour(value.at("warp")), readColour(value.at("weft")),
                  readFromTo(value.at("gloss"), 0.0, 1.0),
                  readPositiveUpTo(value.at("width"), 1.0, "")};
  if (knitted && look.weft != look.warp) {
    value.at("weft").refuseBecause(written(look.weft) + " must be as warp, " + written(look.warp) +
                                   ": a knit has one yarn");
  }
  return look;
}

}  // namespace haptex::material
