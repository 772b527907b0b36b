#include "haptex/dressing/drape_garment.h"

#include <filesystem>
#include <fstream>
#include <ostream>
#include <stdexcept>

#include "haptex/base/command_line.h"
#include "haptex/base/parse_number.h"
#include "haptex/base/quoted.h"
#include "haptex/base/require.h"
#include "haptex/dressing/drape.h"
#include "haptex/garment/body/body_file.h"
#include "haptex/garment/pattern/outfit.h"
#include "haptex/material/fabric_file.h"
#include "haptex/mesh/obj_file.h"
#include "haptex/mesh/obj_writer.h"

namespace haptex::dressing {
namespace {

namespace fs = std::filesystem;

const char* const kUsage =
    "usage: drape_garment GARMENT.yaml OUT.obj --body BODY.obj|BODY.yaml [--edge METRES]\n"
    "Sews a garment on a body and lets it come to rest, with edges of about METRES (0.02):\n"
    "docs/garments.md. OUT.obj has rest coordinates as texture coordinates, and panels as "
    "groups.\n";

struct Request {
  std::string garment, out, body;
  double edge_length = 0.02;  // m
};

Request parse(const std::vector<std::string>& arguments) {
  const base::CommandLine line = base::readCommandLine(arguments, {"--body", "--edge"});
  base::requireTwoFiles(line, "garment");
  Request request = {line.files[0], line.files[1], line.value("--body")};
  if (request.body.empty()) base::refuse("a body is needed: --body BODY.obj or BODY.yaml");
  if (line.options.count("--edge") > 0) {
    const auto length = base::parseNumber<double>(line.value("--edge"));
    if (!length) {
      base::refuse("--edge ", base::quoted(line.value("--edge")),
                   ": allowed is a number of metres");
    }
    request.edge_length = *length;
  }
  return request;
}

std::vector<material::Fabric> loadFabrics(const std::vector<std::string>& names,
                                          const std::string& garment,
                                          const std::string& fabric_directory) {
  std::vector<material::Fabric> fabrics;
  for (const std::string& name : names) {
    fs::path path = fs::path(garment).parent_path() / ".." / "fabrics" / (name + ".yaml");
    std::error_code error;
    if (!fs::is_regular_file(path, error)) path = fs::path(fabric_directory) / (name + ".yaml");
    fabrics.push_back(material::loadFabric(path.lexically_normal().string()));
  }
  return fabrics;
}

/// @param body its surface, as a file of a body or of a surface alone has it
garment::GarmentMesh layOnBody(const Request& request, double edge_length,
                               mesh::ObstacleMesh& body) {
  const garment::Pattern pattern = garment::loadOutfit(request.garment);
  if (fs::path(request.body).extension() != ".yaml") {
    body = mesh::loadObjSurface(request.body);
    return garment::makeGarmentMesh(pattern, edge_length);
  }
  const garment::Body figure = garment::loadBody(request.body);
  body = {figure.vertices, figure.triangles};
  return garment::makeGarmentMesh(pattern, edge_length, figure);
}

void print(const DrapeOutcome& outcome, std::ostream& out) {
  const auto line = [&](const char* name, double value, const char* unit) {
    out << name << '\t' << base::shortNumber(value) << '\t' << unit << '\n';
  };
  const double time = outcome.closing_time + outcome.settling_time;
  line("triangles", static_cast<double>(outcome.mesh.triangles.size()), "");
  line("to_rest", outcome.computing_seconds, "s");
  line("steps", outcome.steps, "");
  line("simulated", time, "s");
  line("s_per_s", outcome.computing_seconds / time, "s/s");
  line("gap_before_sewing", outcome.closed_gap, "m");
  line("fastest", outcome.fastest, "m/s");
  line("intersecting_states", outcome.intersecting_states, "");
  line("intersections_with_itself", static_cast<double>(outcome.with_itself), "");
  line("intersections_with_body", static_cast<double>(outcome.with_body), "");
  out << "at_rest\t" << (outcome.at_rest ? "yes" : "no") << "\t\n";
}

}  // namespace

int drapeGarment(const std::vector<std::string>& arguments, const std::string& fabric_directory,
                 std::ostream& out, std::ostream& err) {
  Request request;
  const auto read = [&] { request = parse(arguments); };
  return base::runProgram(kUsage, err, read, [&] {
    const CoarseStart start = coarseStart(request.edge_length);
    DrapeSettings settings;
    settings.halvings = start.halvings;
    mesh::ObstacleMesh body;
    const garment::GarmentMesh garment = layOnBody(request, start.edge_length, body);
    const std::vector<material::Fabric> fabrics =
        loadFabrics(garment.fabrics, request.garment, fabric_directory);
    const DrapeOutcome outcome = drape(garment, fabrics, body, settings);
    std::ofstream file(request.out);
    mesh::writeObj(outcome.mesh, garment.panel_names, file);
    if (!file.flush()) throw std::runtime_error(request.out + ": cannot be written");
    print(outcome, out);
    if (outcome.isSound()) return 0;
    err << "the garment is not at rest after " << outcome.settling_time
        << " s, or it intersects itself or the body: see above\n";
    return 1;
  });
}

}  // namespace haptex::dressing
