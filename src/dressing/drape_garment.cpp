#include "haptex/dressing/drape_garment.h"

#include <filesystem>
#include <ostream>
#include <sstream>

#include "haptex/base/command_line.h"
#include "haptex/base/require.h"
#include "haptex/base/whole_file.h"
#include "haptex/dressing/drape.h"
#include "haptex/dressing/lay_garment.h"
#include "haptex/dressing/worn_scene.h"
#include "haptex/material/fabric_file.h"
#include "haptex/mesh/obj_writer.h"

namespace haptex::dressing {
namespace {

namespace fs = std::filesystem;

const char* const kUsage =
    "usage: drape_garment GARMENT.yaml OUT.obj --body BODY.obj|BODY.yaml [--edge METRES] "
    "[--scene SCENE.yaml]\n"
    "Sews a garment on a body and lets it come to rest, with edges of about METRES (0.02):\n"
    "docs/garments.md. OUT.obj has rest coordinates as texture coordinates, and panels as "
    "groups.\n"
    "SCENE.yaml is a scene in which it is worn; beside it is the surface of a BODY.yaml, as "
    "SCENE_body.obj.\n";

constexpr double kShortestEdge = 1e-3, kLongestEdge = 1.0;  // m

struct Request {
  std::string garment, out, body;
  std::string scene;          // may be empty
  double edge_length = 0.02;  // m
};

Request parse(const std::vector<std::string>& arguments) {
  const base::CommandLine line = base::readCommandLine(arguments, {"--body", "--edge", "--scene"});
  base::requireTwoFiles(line, "garment");
  Request request = {line.files[0], line.files[1], line.value("--body"), line.value("--scene")};
  if (request.body.empty()) base::refuse("a body is needed: --body BODY.obj or BODY.yaml");
  request.edge_length = line.number(
      "--edge", request.edge_length,
      [](double length) { return length >= kShortestEdge && length <= kLongestEdge; },
      "are 0.001 to 1 m");
  return request;
}

void requireOutputs(const Request& request) {
  base::requireOutput(request.out, {request.garment, request.body});
  if (request.scene.empty()) return;
  base::requireOutput(request.scene, {request.garment, request.body, request.out});
}

std::string fabricPath(const std::string& name, const std::string& garment,
                       const std::string& fabric_directory) {
  fs::path path = fs::path(garment).parent_path() / ".." / "fabrics" / (name + ".yaml");
  std::error_code error;
  if (!fs::is_regular_file(path, error)) path = fs::path(fabric_directory) / (name + ".yaml");
  return path.lexically_normal().string();
}

/// @param write takes the stream
template <typename Write>
void writeFile(const std::string& path, const Write& write) {
  std::ostringstream text;
  write(text);
  base::writeWholeFile(path, text.str());
}

void writeScene(const Request& request, const garment::Pattern& pattern,
                const mesh::ObstacleMesh& body, const std::string& fabric_directory) {
  std::vector<std::string> fabrics;
  for (const garment::Panel& panel : pattern.panels) {
    fabrics.push_back(fabricPath(panel.fabric, request.garment, fabric_directory));
  }
  std::string surface = request.body;
  if (fs::path(surface).extension() == ".yaml") {
    surface = fs::path(request.scene).replace_extension().string() + "_body.obj";
    writeFile(surface, [&](std::ostream& file) { mesh::writeObj(body, file); });
  }
  const WornScene scene{pattern, fabrics, request.out, surface, request.edge_length};
  writeFile(request.scene, [&](std::ostream& file) { writeWornScene(scene, request.scene, file); });
}

void print(const DrapeOutcome& outcome, std::ostream& out) {
  const auto line = [&](const char* name, double value, const char* unit) {
    out << name << '\t' << base::shortNumber(value) << '\t' << unit << '\n';
  };
  const double time = outcome.closing_time + outcome.settling_time;
  line("triangles", static_cast<double>(outcome.mesh.triangles.size()), "");
  line("to_rest", outcome.wall_seconds, "s");
  line("steps", outcome.steps, "");
  line("simulated", time, "s");
  line("s_per_s", outcome.wall_seconds / time, "s/s");
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
    requireOutputs(request);
    const CoarseStart start = coarseStart(request.edge_length);
    DrapeSettings settings;
    settings.halvings = start.halvings;
    settings.threads = allThreads();
    const LaidGarment laid = layGarment(request.garment, request.body, start.edge_length);
    std::vector<material::Fabric> fabrics;
    for (const std::string& name : laid.garment.fabrics) {
      fabrics.push_back(material::loadFabric(fabricPath(name, request.garment, fabric_directory)));
    }
    const DrapeOutcome outcome = drape(laid.garment, fabrics, laid.body, settings);
    writeFile(request.out, [&](std::ostream& file) {
      mesh::writeObj(outcome.mesh, laid.garment.panel_names, file);
    });
    if (!request.scene.empty())
      writeScene(request, laid.garment.pattern, laid.body, fabric_directory);
    print(outcome, out);
    if (outcome.isSound()) return 0;
    err << "the garment is not at rest after " << outcome.settling_time
        << " s, or it intersects itself or the body: see above\n";
    return 1;
  });
}

}  // namespace haptex::dressing
