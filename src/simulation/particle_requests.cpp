#include "haptex/simulation/particle_requests.h"

#include <Eigen/Geometry>
#include <cmath>
#include <sstream>

#include "haptex/base/require.h"

namespace haptex::simulation {

namespace {

using base::refuse;

bool isWithin(const Eigen::Vector3d& vector, double limit) {
  return vector.allFinite() && vector.cwiseAbs().maxCoeff() <= limit;
}

constexpr double kBorder = 1e-9;  // m, around a region, against rounding

void requireExtent(const char* name, const std::vector<double>& extent) {
  const bool two = extent.size() == 2;
  if (two && std::isfinite(extent[0]) && std::isfinite(extent[1]) && extent[0] <= extent[1]) return;
  std::ostringstream numbers;
  for (std::size_t i = 0; i < extent.size(); ++i) numbers << (i > 0 ? ", " : "") << extent[i];
  refuse("region: ", name, " = [", numbers.str(),
         "] m: allowed are two finite numbers, the first not larger, for weft and for warp");
}

}  // namespace

std::string element(const std::string& array, std::size_t index) {
  return array + "[" + std::to_string(index) + "]";
}

void requireParticles(const std::vector<std::uint32_t>& particles, std::size_t count) {
  std::vector<bool> named(count, false);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const std::uint32_t particle = particles[i];
    if (particle >= count) {
      refuse(element("particles", i), " = ", particle, " does not exist: allowed are 0 to ",
             count - 1);
    }
    if (named[particle]) {
      refuse(element("particles", i), " = ", particle,
             " is named twice: allowed is each particle once");
    }
    named[particle] = true;
  }
}

std::vector<std::uint32_t> selectedParticles(const mesh::ClothMesh& mesh,
                                             const std::vector<std::uint32_t>& particles,
                                             const std::vector<double>& weft,
                                             const std::vector<double>& warp) {
  const std::size_t count = mesh.rest_coordinates.size();
  requireParticles(particles, count);
  std::vector<std::uint32_t> selected = particles;
  if (!weft.empty() || !warp.empty()) {
    if (!mesh.corner_coordinates.empty()) {
      refuse("weft and warp name a region of a cloth in one piece, and this one is sewn of ",
             mesh.panelCount(), " panels: allowed are particles by index");
    }
    requireExtent("weft", weft);
    requireExtent("warp", warp);
    std::vector<bool> named(count, false);
    for (const std::uint32_t particle : particles) named[particle] = true;
    const Eigen::AlignedBox2d region(Eigen::Vector2d(weft[0] - kBorder, warp[0] - kBorder),
                                     Eigen::Vector2d(weft[1] + kBorder, warp[1] + kBorder));
    for (std::size_t i = 0; i < count; ++i) {
      if (named[i] || !region.contains(mesh.rest_coordinates[i])) continue;
      selected.push_back(static_cast<std::uint32_t>(i));
    }
    if (selected.empty()) refuse("no particle lies in the region: allowed is at least one");
  }
  return selected;
}

void requireOneEach(const char* name, std::size_t size, std::size_t count,
                    const std::string& instead) {
  if (size == count) return;
  refuse(name, " has ", size, " elements and particles ", count, ": allowed is one for each",
         instead.empty() ? "" : ", or ", instead);
}

void requireWithin(const std::string& name, const Eigen::Vector3d& vector, double limit,
                   const char* unit) {
  if (isWithin(vector, limit)) return;
  refuse(name, " = (", vector.x(), ", ", vector.y(), ", ", vector.z(), ") ", unit,
         ": allowed are finite components from ", -limit, " to ", limit, " ", unit);
}

void requireAllWithin(const char* name, const std::vector<Eigen::Vector3d>& vectors, double limit,
                      const char* unit) {
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    if (!isWithin(vectors[i], limit)) requireWithin(element(name, i), vectors[i], limit, unit);
  }
}

}  // namespace haptex::simulation
