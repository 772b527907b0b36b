// Panels on cylinders and cones: lengths along the surface, and what intersects.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "haptex/garment/body/body_file.h"
#include "haptex/garment/pattern/pattern_file.h"
#include "haptex/garment/placement/preposition.h"
#include "haptex/oracles/checks/garment_oracles.h"
#include "haptex/proximity/intersections.h"

namespace haptex::oracles {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using garment::CarrierSurface;

/// m, by the law of cosines in the sector around the tip, whose sides are long where the cone is
/// nearly a cylinder: in extended precision.
double geodesic(const CarrierSurface& surface, const Vector3d& a, const Vector3d& b) {
  using Real = long double;
  const auto polar = [&](const Vector3d& point) {
    const Vector3d offset = point - surface.origin;
    const Vector3d left = surface.up.cross(surface.front);
    const Real x = offset.dot(surface.front), y = offset.dot(left);
    return std::array<Real, 3>{std::hypot(x, y), std::atan2(y, x), offset.dot(surface.up)};
  };
  const auto [first_radius, first_angle, first_height] = polar(a);
  const auto [second_radius, second_angle, second_height] = polar(b);
  const Real turn = std::remainder(first_angle - second_angle, 2 * std::acos(Real(-1)));
  if (surface.slope == 0.0) {
    const Real radius = (first_radius + second_radius) / 2;
    return static_cast<double>(std::hypot(radius * turn, first_height - second_height));
  }
  const Real slope = std::abs(surface.slope), sine = slope / std::hypot(Real(1), slope);
  const Real first = first_radius / sine, second = second_radius / sine;
  const Real square = first * first + second * second - 2 * first * second * std::cos(sine * turn);
  return static_cast<double>(std::sqrt(std::max(Real(0), square)));
}

/// Of all edges of a garment on a body: change along the surface; and pairs of triangles that
/// intersect, of panels with each other or with the body.
void validateGarmentOn(const std::string& config_directory, const std::string& name,
                       const std::string& body_name, const Sink& sink) {
  const garment::Pattern pattern =
      garment::loadPattern(config_directory + "/garments/" + name + ".yaml");
  const garment::Body body = garment::loadBody(config_directory + "/bodies/" + body_name + ".yaml");
  std::vector<garment::PanelMesh> meshes;
  for (const garment::Panel& panel : pattern.panels) {
    meshes.push_back(garment::triangulate(panel, 0.02));
  }
  const garment::Preposition laid = garment::preposition(pattern, body, meshes);
  double change = 0.0;
  for (const garment::LaidPanel& panel : laid.panels) {
    const mesh::ClothMesh& mesh = meshes[panel.panel].mesh;
    for (const auto& triangle : mesh.triangles) {
      for (int i = 0; i < 3; ++i) {
        const int a = triangle[i], b = triangle[(i + 1) % 3];
        const double rest = (mesh.rest_coordinates[a] - mesh.rest_coordinates[b]).norm();
        const double length =
            geodesic(panel.surface, mesh.initial_positions[a], mesh.initial_positions[b]);
        change = base::largerOrNaN(change, std::abs(length / rest - 1.0));
      }
    }
  }
  std::vector<Vector3d> positions = body.vertices;
  std::vector<std::array<int, 3>> triangles = body.triangles;
  const int first_panel = static_cast<int>(triangles.size());
  for (const garment::PanelMesh& mesh : meshes) {
    const int first = static_cast<int>(positions.size());
    positions.insert(positions.end(), mesh.mesh.initial_positions.begin(),
                     mesh.mesh.initial_positions.end());
    for (const auto& [a, b, c] : mesh.mesh.triangles) {
      triangles.push_back({first + a, first + b, first + c});
    }
  }
  double intersections = 0.0;
  for (const auto& pair : proximity::intersectingTriangles(positions, triangles)) {
    if (pair[1] >= first_panel) ++intersections;  // what the body does to itself does not count
  }
  const std::string quantity = "garment/laid/" + name + "_on_" + body_name + "/";
  sink({quantity + "change_of_an_edge_along_the_surface", 0.0, change, change, 1e-9});
  sink({quantity + "intersections", 0.0, intersections, intersections, 0.0});
}

/// A panel of 0.3 x 0.2 m on a cone with a half angle of 30 degrees, whose middle is 0.5 m from
/// its tip: its corners against polar coordinates around the tip, which unrolled is a half disc.
void validateCone(const Sink& sink) {
  CarrierSurface cone;  // tip at z = 0.5 cos 30 degrees, narrower upwards
  const double sine = 0.5, cosine = std::sqrt(0.75), middle = 0.5;
  cone.radius = middle * sine;
  cone.slope = sine / cosine;
  double error = 0.0;
  for (const double x : {-0.15, 0.15}) {
    for (const double y : {-0.1, 0.1}) {
      const double rho = std::hypot(x, middle - y), phi = std::atan2(x, middle - y);
      const double angle = 0.3 + phi / sine;
      const Vector3d exact(rho * sine * std::cos(angle), rho * sine * std::sin(angle),
                           (middle - rho) * cosine);
      const Vector3d laid = garment::lay(cone, {0.3, 0.0}, {x, y});
      error = base::largerOrNaN(error, (laid - exact).norm());
    }
  }
  sink({"garment/laid/panel_on_a_cone/corners_m", 0.0, error, error, 1e-14});
}

}  // namespace

void validatePreposition(const std::string& config_directory, const Sink& sink) {
  validateCone(sink);
  for (const char* name : {"fitted_shirt", "fitted_dress"}) {
    for (const char* body : {"woman", "man"}) {
      validateGarmentOn(config_directory, name, body, sink);
    }
  }
}

}  // namespace haptex::oracles
