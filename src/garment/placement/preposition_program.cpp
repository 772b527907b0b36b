#include "haptex/garment/placement/preposition_program.h"

#include <fstream>
#include <ostream>
#include <stdexcept>

#include "haptex/base/command_line.h"
#include "haptex/base/require.h"
#include "haptex/garment/body/body_file.h"
#include "haptex/garment/pattern/outfit.h"
#include "haptex/garment/placement/preposition.h"
#include "haptex/mesh/obj_writer.h"

namespace haptex::garment {
namespace {

const char* const kUsage =
    "usage: preposition GARMENT.yaml BODY.yaml OUT.obj [--edge METRES] [--body BODY.obj]\n"
    "Lays the panels of a garment around a body, in triangles with edges of METRES (0.01), and\n"
    "writes them and the body as OBJ files: docs/bodies.md.\n";

struct Request {
  std::vector<std::string> files;
  std::string body_obj;
  double edge = 0.0;  // m
};

Request parse(const std::vector<std::string>& arguments) {
  const base::CommandLine line = base::readCommandLine(arguments, {"--edge", "--body"});
  if (line.files.size() != 3) {
    base::refuse(line.files.size(),
                 " files: needed are three, the garment, the body and the one to write");
  }
  const double edge = line.number(
      "--edge", 0.01, [](double length) { return length >= 1e-3 && length <= 1.0; },
      "are 0.001 to 1 m");
  return {line.files, line.value("--body"), edge};
}

void requireOutputs(const Request& request) {
  const std::vector<std::string>& files = request.files;
  base::requireOutput(files[2], {files[0], files[1]});
  if (!request.body_obj.empty()) base::requireOutput(request.body_obj, files);
}

std::ofstream openToWrite(const std::string& path) {
  std::ofstream file(path);
  if (!file) throw std::runtime_error(path + ": cannot be written");
  return file;
}

void requireWritten(std::ofstream& file, const std::string& path) {
  if (!file.flush()) throw std::runtime_error(path + ": cannot be written");
}

void writePanels(const Pattern& pattern, const std::vector<PanelMesh>& meshes,
                 const std::string& path) {
  std::vector<std::string> names;
  for (const Panel& panel : pattern.panels) names.push_back(panel.name);
  std::ofstream file = openToWrite(path);
  mesh::writeObj(joined(meshes), names, file);
  requireWritten(file, path);
}

void writeBody(const Body& body, const std::string& path) {
  std::ofstream file = openToWrite(path);
  file << "g body\n";
  mesh::writeObj(mesh::ObstacleMesh{body.vertices, body.triangles}, file);
  requireWritten(file, path);
}

void print(const Pattern& pattern, const Preposition& laid, std::ostream& out) {
  out << "# panel\tname\tradius_m\tslope\tangle_rad\talong\tchange_along_surface\t"
         "change_of_straight_edges\tsagitta_m\n";
  for (const LaidPanel& panel : laid.panels) {
    out << "panel\t" << pattern.panels[panel.panel].name;
    for (const double value : {panel.surface.radius, panel.surface.slope, panel.angle, panel.along,
                               panel.surface_change, panel.straight_change, panel.sagitta}) {
      out << '\t' << base::shortNumber(value);
    }
    out << '\n';
  }
  out << "# intersect\tfirst\tsecond\tpairs\n";
  for (const Overlap& overlap : laid.overlaps) {
    out << "intersect\t" << overlap.first << '\t' << overlap.second << '\t' << overlap.pairs
        << '\n';
  }
}

}  // namespace

int prepositionProgram(const std::vector<std::string>& arguments, std::ostream& out,
                       std::ostream& err) {
  Request request;
  const auto read = [&] { request = parse(arguments); };
  return base::runProgram(kUsage, err, read, [&] {
    requireOutputs(request);
    const Pattern pattern = loadOutfit(request.files[0]);
    const Body body = loadBody(request.files[1]);
    std::vector<PanelMesh> meshes;
    for (const Panel& panel : pattern.panels) meshes.push_back(triangulate(panel, request.edge));
    const Preposition laid = preposition(pattern, body, meshes);
    writePanels(pattern, meshes, request.files[2]);
    if (!request.body_obj.empty()) writeBody(body, request.body_obj);
    print(pattern, laid, out);
    return laid.overlaps.empty() ? 0 : 3;
  });
}

}  // namespace haptex::garment
