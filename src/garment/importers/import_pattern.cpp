#include "haptex/garment/importers/import_pattern.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <ostream>

#include "haptex/base/command_line.h"
#include "haptex/base/require.h"
#include "haptex/garment/importers/dxf_pattern.h"
#include "haptex/garment/importers/garment_code.h"
#include "haptex/garment/pattern/pattern_file.h"

namespace haptex::garment {
namespace {

namespace fs = std::filesystem;

const char* const kUsage =
    "usage: import_pattern FILE.json|FILE.dxf OUT.yaml [--fabric NAME]\n"
    "Makes a garment file of a pattern of GarmentCode (JSON) or in DXF (AAMA, ASTM D6673) with "
    "its\n"
    "seams in FILE.seams.yaml; its panels are of the fabric NAME (wool): docs/garments.md.\n";

struct Request {
  std::string file, out, fabric;
};

Request parse(const std::vector<std::string>& arguments) {
  const base::CommandLine line = base::readCommandLine(arguments, {"--fabric"});
  base::requireTwoFiles(line, "pattern");
  const Request request = {line.files[0], line.files[1], line.value("--fabric", "wool")};
  if (request.fabric.empty()) base::refuse("--fabric needs a name");
  return request;
}

std::string extensionOf(const std::string& file) {
  std::string extension = fs::path(file).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

std::string sidecarOf(const std::string& file) {
  return fs::path(file).replace_extension(".seams.yaml").string();
}

// It must not take the place of what it is made of.
void requireOutput(const Request& request) {
  if (extensionOf(request.out) != ".yaml" ||
      fs::path(request.out).lexically_normal() ==
          fs::path(sidecarOf(request.file)).lexically_normal()) {
    base::refuse(request.out, ": allowed is the name of a file with .yaml, but not ",
                 sidecarOf(request.file));
  }
}

ImportedPattern import(const Request& request) {
  const std::string extension = extensionOf(request.file);
  if (extension != ".json" && extension != ".dxf") {
    base::refuse(request.file, ": has the extension '", extension, "': allowed are .json and .dxf");
  }
  const std::string text = readPatternText(request.file);
  ImportedPattern imported;
  if (extension == ".json") {
    imported.pattern = importGarmentCode(text, request.file, request.fabric);
  } else {
    const std::string sidecar = sidecarOf(request.file);
    const bool there = fs::exists(sidecar);
    imported = importDxf(text, request.file, there ? readPatternText(sidecar) : "", sidecar,
                         request.fabric);
  }
  imported.pattern.source = "imported from " + fs::path(request.file).filename().string();
  return imported;
}

void print(const ImportedPattern& imported, std::ostream& out) {
  const Pattern& pattern = imported.pattern;
  out << "# panel\tname\tholes\tarea_m2\n# edge\tnumber\tlength_m\tfrom_x\tfrom_y\tto_x\tto_y\n";
  for (const Panel& panel : pattern.panels) {
    out << "panel\t" << panel.name << '\t' << panel.outlines.size() - 1 << '\t'
        << base::shortNumber(areaOf(panel)) << '\n';
    for (std::size_t e = 0; e < panel.outlines.front().size(); ++e) {
      const Curve& curve = panel.outlines.front()[e].curve;
      out << "edge\t" << e << '\t' << base::shortNumber(curve.length());
      for (const Eigen::Vector2d& end : {curve.start(), curve.end()}) {
        out << '\t' << base::shortNumber(end.x()) << '\t' << base::shortNumber(end.y());
      }
      out << '\n';
    }
  }
  out << "# seam\tfirst\tsecond\tfirst_m\tsecond_m\teasing\n";
  for (const Seam& seam : pattern.seams) {
    out << "seam";
    for (const SeamSide& side : seam.sides) {
      out << '\t' << pattern.panels[side.panel].name << ':' << side.first;
      if (side.last != side.first) out << '-' << side.last;
    }
    for (const SeamSide& side : seam.sides) {
      out << '\t' << base::shortNumber(lengthOf(pattern, side));
    }
    out << '\t' << base::shortNumber(seam.easing) << '\n';
  }
  for (const std::string& note : imported.notes) out << "# " << note << '\n';
}

}  // namespace

int importPattern(const std::vector<std::string>& arguments, std::ostream& out, std::ostream& err) {
  Request request;
  const auto read = [&] {
    request = parse(arguments);
    requireOutput(request);
  };
  return base::runProgram(kUsage, err, read, [&] {
    base::requireOutput(request.out, {request.file});
    const ImportedPattern imported = import(request);
    std::ofstream file(request.out);
    file << writePattern(imported.pattern) << std::flush;
    if (!file) throw std::runtime_error(request.out + ": cannot be written");
    print(imported, out);
    return 0;
  });
}

}  // namespace haptex::garment
