#include "haptex/simulation/particle_requests.h"

#include "haptex/base/require.h"

namespace haptex::simulation {

namespace {

using base::refuse;

bool isWithin(const Eigen::Vector3d& vector, double limit) {
  return vector.allFinite() && vector.cwiseAbs().maxCoeff() <= limit;
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
