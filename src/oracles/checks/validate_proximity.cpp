#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "haptex/base/workload.h"
#include "haptex/mesh/mesh.h"
#include "haptex/oracles/checks/validation.h"
#include "haptex/oracles/experiments/fcl_sheet.h"
#include "haptex/oracles/scenes/deformed_sheets.h"
#include "haptex/proximity/kdop_hierarchy.h"

namespace haptex::oracles {
namespace {

using namespace proximity;
using Eigen::Vector3d;
using Positions = std::vector<Vector3d>;

constexpr int kCells = 16;  // 512 triangles: brute force is to be affordable
constexpr int kQueriesPerState = base::unlessSanitized(1000, 50);

/// A place and sizes to make a cursor of, on the scale of a few elements.
struct Ingredients {
  Sphere spheres[3];
  double distance;  // m
};

using MakeCursor = Cursor (*)(const Ingredients&);

struct Shape {
  const char* name;
  MakeCursor cursor;
};

const Shape kShapes[] = {
    {"point", [](const Ingredients& i) { return Cursor::point(i.spheres[0].centre); }},
    {"sphere", [](const Ingredients& i) { return Cursor::spheres({i.spheres[0]}); }},
    {"three_spheres",
     [](const Ingredients& i) {
       return Cursor::spheres({i.spheres[0], i.spheres[1], i.spheres[2]});
     }},
    {"capsule",
     [](const Ingredients& i) {
       return Cursor::capsule(i.spheres[0].centre, i.spheres[1].centre, i.spheres[0].radius);
     }},
    {"tapered_capsule",
     [](const Ingredients& i) { return Cursor::taperedCapsule(i.spheres[0], i.spheres[1]); }},
};

class Sheet {
 public:
  Sheet()
      : mesh_(mesh::makeRectangle(0.2, 0.2, kCells, kCells, mesh::Triangulation::kAlternating)),
        states_(deformedSheets(mesh_)),
        hierarchy_(mesh_.triangles, states_.front().positions) {}

  const std::vector<DeformedSheet>& states() const { return states_; }

  void setState(const DeformedSheet& state) {
    hierarchy_.refit(state.positions);
    const Triangle corners = hierarchy_.triangle(0);
    size_ = std::max((corners[1] - corners[0]).norm(), 1e-9);
  }

  Ingredients ingredients(std::mt19937& generator) const {
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const auto offset = [&] { return 4.0 * size_ * (unit(generator) - 0.5); };
    Ingredients made;
    const Positions& positions = hierarchy_.positions();
    const auto particle = static_cast<std::size_t>(unit(generator) * positions.size());
    for (Sphere& sphere : made.spheres) {
      const double x = offset(), y = offset(), z = offset();
      sphere = {positions[particle] + Vector3d(x, y, z), 2.0 * size_ * unit(generator)};
    }
    made.distance = 2.0 * size_ * unit(generator);
    return made;
  }

  const KdopHierarchy& hierarchy() const { return hierarchy_; }

 private:
  mesh::ClothMesh mesh_;
  std::vector<DeformedSheet> states_;
  KdopHierarchy hierarchy_;
  double size_ = 0.0;  // m, of an element
};

bool same(const std::vector<NearElement>& a, const std::vector<NearElement>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const NearElement& x, const NearElement& y) {
                      return x.triangle == y.triangle && x.part == y.part &&
                             x.distance == y.distance && x.point == y.point;
                    });
}

/// Queries whose answer is another than that of brute force, in all states.
base::Quantity compareWithBruteForce(Sheet& sheet, const Shape& shape, bool nearest) {
  std::mt19937 generator(1);
  std::vector<NearElement> found;
  int queries = 0, wrong = 0;
  for (const DeformedSheet& state : sheet.states()) {
    sheet.setState(state);
    const KdopHierarchy& hierarchy = sheet.hierarchy();
    for (int i = 0; i < kQueriesPerState / (nearest ? 5 : 1); ++i) {
      const Ingredients made = sheet.ingredients(generator);
      const Cursor cursor = shape.cursor(made);
      Range range{made.distance};
      if (nearest) range.count = 1 + generator() % 20;
      hierarchy.query(cursor, range, found);
      ++queries;
      wrong += !same(found, nearElementsByBruteForce(hierarchy.triangles(), hierarchy.positions(),
                                                     cursor, range));
    }
  }
  return {"proximity/" + std::string(shape.name) + (nearest ? "/nearest" : "/all") + "/wrong_of_" +
              std::to_string(queries),
          0.0, static_cast<double>(wrong), static_cast<double>(wrong), 0.0};
}

/// FCL and we may differ about elements that touch the sphere to within rounding (m, relative to
/// the coordinates).
constexpr double kTouching = 1e-12;

/// Sphere queries in which FCL finds another set of elements.
base::Quantity compareWithFcl(Sheet& sheet) {
  std::mt19937 generator(2);
  int queries = 0, wrong = 0;
  for (const DeformedSheet& state : sheet.states()) {
    if (state.name == "on_a_line" || state.name == "on_a_point") continue;  // FCL needs areas
    sheet.setState(state);
    const KdopHierarchy& hierarchy = sheet.hierarchy();
    const FclSheet<fcl::OBBRSSd> in_fcl(hierarchy.triangles(), state.positions);
    for (int i = 0; i < kQueriesPerState; ++i) {
      const Sphere sphere = sheet.ingredients(generator).spheres[0];
      const double touching = kTouching * (1.0 + sphere.centre.norm());
      ++queries;
      wrong += !agree(hierarchy, in_fcl, sphere, touching);
    }
  }
  return {"proximity/sphere/other_than_fcl_of_" + std::to_string(queries), 0.0,
          static_cast<double>(wrong), static_cast<double>(wrong), 0.0};
}

}  // namespace

void validateProximity(const std::string&, const Sink& sink) {
  Sheet sheet;
  for (const Shape& shape : kShapes) {
    for (const bool nearest : {false, true}) {
      sink(compareWithBruteForce(sheet, shape, nearest));
    }
  }
  sink(compareWithFcl(sheet));
}

}  // namespace haptex::oracles
