// The oracles of bending: strips at rest.
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "haptex/base/workload.h"
#include "haptex/oracles/checks/cloth_oracles.h"
#include "haptex/oracles/exact/elastica.h"
#include "haptex/oracles/experiments/strip_statics.h"

namespace haptex::oracles {
namespace {

constexpr double kDropTolerance = 0.02;
constexpr double kElasticaTolerance = 1e-4;  // of the table, which has six digits after the point
constexpr double kBucklingTolerance = 0.05;
constexpr double kSagTolerance = 0.005;
constexpr double kCircleTolerance = 0.02;

constexpr std::array<std::pair<cloth::BendingModel, const char*>, 2> kModels = {
    {{cloth::BendingModel::kLinear, "linear"}, {cloth::BendingModel::kQuadratic, "quadratic"}}};

/// Gamma and drop over reach of the elastica, solved as a boundary value problem; within 0.15 % of
/// the published master curve of Romero et al. 2021 (doi 10.1145/3450626.3459939).
constexpr std::array<std::array<double, 2>, 4> kElastica = {
    {{0.1, 0.012500}, {1.0, 0.124562}, {10.0, 1.066802}, {100.0, 5.888105}}};

std::string gammaName(double gamma) {
  return gamma < 1.0 ? "gamma0.1" : "gamma" + std::to_string(static_cast<int>(gamma));
}

void validateCantilevers(const Sink& sink) {
  for (const auto& [gamma, exact] : kElastica) {
    if (base::kSanitized && gamma > kElastica.front()[0]) break;
    sink(base::relativeTo(exact, "cloth/elastica/" + gammaName(gamma), exact,
                          exactDropOverReach(gamma), kElasticaTolerance));
    for (const NamedStripMesh& mesh : kStripMeshes) {
      for (const auto& [model, model_name] : kModels) {
        for (kes::Direction along : {kes::Direction::kWeft, kes::Direction::kWarp}) {
          if (base::kSanitized && along == kes::Direction::kWarp) continue;
          Cantilever cantilever{gamma, mesh.mesh, along};
          cantilever.model = model;
          sink(base::relativeTo(exact,
                                std::string("cloth/cantilever/") + model_name + "/" + mesh.name +
                                    "/" + nameOf(along) + "/" + gammaName(gamma),
                                exact, simulatedDropOverReach(cantilever), kDropTolerance));
        }
      }
    }
  }
}

/// The circle of 1 / curvature on which a free strip settles, both ways.
void validateRestCurvature(const NamedStripMesh& mesh, const Sink& sink) {
  for (const auto& [model, model_name] : kModels) {
    for (const auto& [along, curvature] :
         {std::pair(kes::Direction::kWeft, 20.0), std::pair(kes::Direction::kWarp, -40.0)}) {
      if (base::kSanitized && along == kes::Direction::kWeft) continue;
      sink(base::relativeTo(
          curvature,
          std::string("cloth/rest_curvature/") + model_name + "/" + mesh.name + "/" + nameOf(along),
          curvature, simulatedRestCurvature(mesh.mesh, along, model, curvature), kCircleTolerance));
    }
  }
}

/// What is left of the curvature of a free strip that was bent further than friction holds.
void validateResidualCurvature(const NamedStripMesh& mesh, const Sink& sink) {
  for (const auto& [model, model_name] : kModels) {
    for (const auto& [along, held] :
         {std::pair(kes::Direction::kWeft, 20.0), std::pair(kes::Direction::kWarp, 10.0)}) {
      if (base::kSanitized && along == kes::Direction::kWarp) continue;
      sink(base::relativeTo(held,
                            std::string("cloth/residual_curvature/") + model_name + "/" +
                                mesh.name + "/" + nameOf(along),
                            held, simulatedResidualCurvature(mesh.mesh, along, model, held),
                            kCircleTolerance));
    }
  }
}

}  // namespace

void validateBending(const Sink& sink) {
  validateCantilevers(sink);
  for (const NamedStripMesh& mesh : kStripMeshes) {
    if (base::kSanitized && mesh.mesh != StripMesh::kIrregular)
      continue;  // the cantilevers had all
    validateRestCurvature(mesh, sink);
    validateResidualCurvature(mesh, sink);
    sink(base::relativeTo(kLateralBucklingLoad, std::string("cloth/lateral_buckling/") + mesh.name,
                          kLateralBucklingLoad, simulatedLateralBucklingLoad(mesh.mesh, 90),
                          kBucklingTolerance));
    sink(base::relativeTo(exactSagOverSpan(), std::string("cloth/catenary/") + mesh.name,
                          exactSagOverSpan(), simulatedSagOverSpan(mesh.mesh, 60), kSagTolerance));
  }
}

}  // namespace haptex::oracles
