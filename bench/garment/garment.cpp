// How long does it take from a pattern to a garment at rest on a body, and does it get there from
// any start? Prints for the shipped shirt with edges of 20 mm the processor time from the flat
// panels to rest (inf: it did not come to rest), per simulated second too, and the pairs of
// triangles that intersect at rest. Then panels start somewhere else: each up to 10 mm away in
// every direction and turned by up to 0.02 rad; of so many starts (20, or the first argument), how
// many ended at rest without an intersection?
#include <Eigen/Geometry>
#include <cstdlib>
#include <exception>
#include <limits>
#include <string>
#include <vector>

#include "haptex/base/repeatable_random.h"
#include "haptex/dressing/drape.h"
#include "haptex/garment/pattern/pattern_file.h"
#include "haptex/material/fabric_file.h"
#include "haptex/mesh/obj_file.h"
#include "tab_lines.h"

namespace {

using namespace haptex;
using Eigen::Vector3d;

constexpr double kEdgeLength = 0.02;           // m
constexpr double kShift = 0.01, kTurn = 0.02;  // m, rad
constexpr int kStarts = 20;

void disturb(garment::Pattern& pattern, unsigned seed) {
  base::RepeatableRandom random(seed);
  for (garment::Panel& panel : pattern.panels) {
    auto& pose = std::get<Eigen::Isometry3d>(panel.placement);
    const auto draw = [&](double most) {
      return Vector3d(random.uniform(-most, most), random.uniform(-most, most),
                      random.uniform(-most, most));
    };
    pose.translation() += draw(kShift);
    const Vector3d turn = draw(kTurn);
    pose.linear() =
        Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix() * pose.linear();
  }
}

dressing::DrapeOutcome drape(const garment::Pattern& pattern, const mesh::ObstacleMesh& body) {
  const garment::GarmentMesh garment = garment::makeGarmentMesh(pattern, kEdgeLength);
  std::vector<material::Fabric> fabrics;
  for (const std::string& name : garment.fabrics) {
    fabrics.push_back(material::loadFabric(HAPTEX_CONFIG_DIRECTORY "/fabrics/" + name + ".yaml"));
  }
  return dressing::drape(garment, fabrics, body, {});
}

bool endsAtRest(const garment::Pattern& pattern, const mesh::ObstacleMesh& body) {
  try {
    return drape(pattern, body).isSound();
  } catch (const std::exception& refusal) {
    std::fprintf(stderr, "%s\n", refusal.what());
    return false;
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int starts = argc > 1 ? std::atoi(argv[1]) : kStarts;
  const mesh::ObstacleMesh body =
      mesh::loadObjSurface(HAPTEX_SOURCE_DIRECTORY "/config/meshes/figure.obj");
  const garment::Pattern shirt =
      garment::loadPattern(HAPTEX_CONFIG_DIRECTORY "/garments/shirt.yaml");
  const dressing::DrapeOutcome outcome = drape(shirt, body);
  const std::string name = "garment/shirt/";
  bench::printLine(name + "s_per_s",
                   outcome.computing_seconds / (outcome.closing_time + outcome.settling_time),
                   "s/s");
  constexpr double kNever = std::numeric_limits<double>::infinity();
  bench::printLine(name + "to_rest", outcome.at_rest ? outcome.computing_seconds : kNever, "s");
  bench::printLine(name + "intersections",
                   static_cast<double>(outcome.with_itself + outcome.with_body), "1");
  int at_rest = 0;
  for (int seed = 1; seed <= starts; ++seed) {
    garment::Pattern disturbed = shirt;
    disturb(disturbed, static_cast<unsigned>(seed));
    at_rest += endsAtRest(disturbed, body) ? 1 : 0;
  }
  bench::printLine(name + "at_rest", at_rest, ("of " + std::to_string(starts)).c_str());
}
