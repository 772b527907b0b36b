#include "haptex/scene/step_values.h"

#include <stdexcept>
#include <string>

namespace haptex::scene {
namespace {

using base::YamlValue;

constexpr double kLargestError = 1.0;  // m
constexpr int kMaxNewtonIterations = 1000;

cloth::IntegrationMethod readIntegrator(const YamlValue& value) {
  std::vector<const char*> names;
  for (const cloth::NamedIntegrationMethod& named : cloth::kIntegrationMethods) {
    names.push_back(named.name);
  }
  const std::string name = value.oneOf(names);
  for (const cloth::NamedIntegrationMethod& named : cloth::kIntegrationMethods) {
    if (name == named.name) return named.method;
  }
  throw std::logic_error("the integrator " + name + " has no method");
}

linear::LinearSolverMethod readMethod(const YamlValue& value) {
  const std::string method = value.oneOf({"automatic", "conjugate_gradient", "cholesky"});
  if (method == "automatic") return linear::LinearSolverMethod::kAutomatic;
  return method == "cholesky" ? linear::LinearSolverMethod::kCholesky
                              : linear::LinearSolverMethod::kConjugateGradient;
}

void readSolver(const YamlValue& value, cloth::StepSettings& settings) {
  value.requireKeys({}, {"method", "tolerance", "newton_iterations", "error", "threads"});
  if (value.has("method")) settings.solver = readMethod(value.at("method"));
  if (value.has("tolerance")) {
    settings.tolerance = value.at("tolerance").number();
    if (settings.tolerance <= 0.0 || settings.tolerance >= 1.0) {
      value.at("tolerance").refuse("must be > 0 and < 1");
    }
  }
  if (value.has("newton_iterations")) {
    settings.newton_iterations = value.at("newton_iterations").integer();
    if (settings.newton_iterations < 1 || settings.newton_iterations > kMaxNewtonIterations) {
      value.at("newton_iterations").refuse("must be an integer from 1 to 1000");
    }
  }
  if (value.has("error")) {
    settings.newton_error = value.at("error").number();
    if (settings.newton_error <= 0.0 || settings.newton_error >= 1.0) {
      value.at("error").refuse("must be > 0 and < 1");
    }
    if (settings.newton_iterations < 2) {
      value.at("error").refuse("needs newton_iterations of at least 2 to reach it");
    }
  }
  if (value.has("threads")) {
    settings.threads = value.at("threads").integer();
    if (settings.threads < 1 || settings.threads > cloth::kMaxThreads) {
      value.at("threads").refuse("must be an integer from 1 to " +
                                 std::to_string(cloth::kMaxThreads));
    }
  }
}

}  // namespace

double readTimeStep(const YamlValue& value) {
  const double time_step = value.number();
  if (time_step < kShortestTimeStep || time_step > kLongestTimeStep) {
    value.refuse("must be from 1e-6 to 10 s");
  }
  return time_step;
}

cloth::AdaptiveSteps readAdaptiveSteps(const YamlValue& map) {
  map.requireKeys({"from", "to", "error"});
  cloth::AdaptiveSteps steps;
  steps.shortest = readTimeStep(map.at("from"));
  steps.longest = readTimeStep(map.at("to"));
  if (steps.longest < steps.shortest) map.at("to").refuse("must not be shorter than from");
  steps.error = map.at("error").number();
  if (steps.error <= 0.0 || steps.error > kLargestError) {
    map.at("error").refuse("must be > 0 and at most 1 m");
  }
  return steps;
}

cloth::StepSettings readStepSettings(const YamlValue& map) {
  cloth::StepSettings settings;
  if (map.has("integrator")) settings.method = readIntegrator(map.at("integrator"));
  if (!map.has("solver")) return settings;
  if (!cloth::isImplicit(settings.method)) {
    map.at("solver").refuseBecause("is allowed only with an implicit integrator, which " +
                                   map.at("integrator").text() + " is not");
  }
  readSolver(map.at("solver"), settings);
  return settings;
}

}  // namespace haptex::scene
