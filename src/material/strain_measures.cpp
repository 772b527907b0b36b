#include "haptex/material/strain_measures.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace haptex::material {

// ((1 + e)^2 - 1)/2 without the cancellation near zero.
double greenStrain(double engineering_strain) {
  return engineering_strain * (1.0 + 0.5 * engineering_strain);
}

// l - 1 = (l^2 - 1)/(l + 1) without the cancellation near zero.
double engineeringStrain(double green_strain) {
  return 2.0 * green_strain / (1.0 + std::sqrt(1.0 + 2.0 * green_strain));
}

double secondPiolaStress(double force_per_width, double engineering_strain) {
  return force_per_width / (1.0 + engineering_strain);
}

double forcePerWidth(double second_piola_stress, double green_strain) {
  return second_piola_stress * std::sqrt(1.0 + 2.0 * green_strain);
}

std::vector<CurvePoint> curvePointsFromTester(const std::vector<CurvePoint>& tester_samples) {
  std::vector<CurvePoint> points;
  points.reserve(tester_samples.size());
  for (const auto& [strain, force] : tester_samples) {
    const bool strain_allowed = std::isfinite(strain) && strain > -1.0;
    if (!strain_allowed || !std::isfinite(force)) {
      std::ostringstream message;
      message << "points[" << points.size()
              << "]: " << (strain_allowed ? "force per width " : "engineering strain ")
              << (strain_allowed ? force : strain)
              << (strain_allowed ? " must be finite" : " must be finite and > -1");
      throw std::invalid_argument(message.str());
    }
    points.push_back({greenStrain(strain), secondPiolaStress(force, strain)});
  }
  return points;
}

}  // namespace haptex::material
