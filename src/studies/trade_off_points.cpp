#include "haptex/studies/trade_off_points.h"

#include <string>
#include <vector>

#include "haptex/material/fabric_file.h"

namespace haptex::studies {
namespace {

using cloth::Elasticity;
using cloth::IntegrationMethod;
using linear::LinearSolverMethod;

TradeOffPoint pointOf(IntegrationMethod method, int cells, int steps_per_cycle, int solves) {
  TradeOffPoint point;
  point.step.method = method;
  point.step.newton_iterations = solves;
  point.cells = cells;
  point.steps_per_cycle = steps_per_cycle;
  return point;
}

/// Whose steps end by an error, with as many solves as that takes.
TradeOffPoint pointTo(double error, IntegrationMethod method, int cells, int steps_per_cycle) {
  TradeOffPoint point = pointOf(method, cells, steps_per_cycle, 20);
  point.step.newton_error = error;
  return point;
}

/// Implicit methods with Green-Lagrange elements: every resolution with every step.
void addGrid(std::vector<TradeOffPoint>& points) {
  for (int cells : {16, 12}) {
    for (int steps : {4, 2, 1}) {
      for (int solves : {1, 2, 3}) {
        points.push_back(pointOf(IntegrationMethod::kBackwardEuler, cells, steps, solves));
      }
      points.push_back(pointOf(IntegrationMethod::kBackwardMidpoint, cells, steps, 2));
      for (IntegrationMethod method : {IntegrationMethod::kBackwardEuler, IntegrationMethod::kBdf2,
                                       IntegrationMethod::kTrBdf2}) {
        points.push_back(pointTo(1e-2, method, cells, steps));
      }
    }
  }
  for (IntegrationMethod method : {IntegrationMethod::kBdf2, IntegrationMethod::kTrBdf2}) {
    for (double error : {1e-1, 1e-3}) points.push_back(pointTo(error, method, 16, 1));
  }
  points.push_back(pointOf(IntegrationMethod::kBackwardEuler, 8, 1, 2));
}

/// So fine that swings are right to a millimetre: followed as far as that is worth its time.
void addFine(std::vector<TradeOffPoint>& points) {
  for (int cells : {24, 20}) {
    for (int steps : {2, 1}) {
      points.push_back(pointTo(1e-2, IntegrationMethod::kTrBdf2, cells, steps));
    }
  }
}

/// Tolerances and solvers, which is precision, too: automatic preconditions by a factor in single
/// precision, the others compute in double precision.
void addSolvers(std::vector<TradeOffPoint>& points) {
  const TradeOffPoint base = pointOf(IntegrationMethod::kBackwardEuler, 16, 1, 2);
  for (double tolerance : {1e-1, 1e-2, 1e-3, 1e-4, 1e-10}) {
    points.push_back(base);
    points.back().step.tolerance = tolerance;
  }
  for (LinearSolverMethod solver :
       {LinearSolverMethod::kCholesky, LinearSolverMethod::kConjugateGradient}) {
    points.push_back(base);
    points.back().step.solver = solver;
  }
}

void addModels(std::vector<TradeOffPoint>& points) {
  for (Elasticity elasticity : {Elasticity::kMassSpring, Elasticity::kCorotational}) {
    for (int cells : {16, 8}) {
      for (int steps : {4, 1}) {
        points.push_back(pointOf(IntegrationMethod::kBackwardEuler, cells, steps, 2));
        points.back().elasticity = elasticity;
      }
    }
  }
}

/// With the coarsest mesh, and steps of 0.39 and 0.1 ms.
void addExplicit(std::vector<TradeOffPoint>& points) {
  for (IntegrationMethod method :
       {IntegrationMethod::kExplicitEuler, IntegrationMethod::kExplicitMidpoint,
        IntegrationMethod::kRungeKutta4, IntegrationMethod::kTwoStepEuler}) {
    for (int steps : {32, 128}) points.push_back(pointOf(method, 8, steps, 1));
  }
}

/// Of the thicknesses at which layers meet.
void addThicknesses(std::vector<TradeOffPoint>& points) {
  for (double thickness : {0.5, 2.0, 4.0}) {
    points.push_back(pointTo(1e-2, IntegrationMethod::kBdf2, 16, 1));
    points.back().thickness = thickness;
    points.push_back(pointTo(1e-2, IntegrationMethod::kBdf2, 16, 4));
    points.back().thickness = thickness;
  }
}

}  // namespace

const std::vector<std::string>& tradeOffFabrics() {
  static const std::vector<std::string> fabrics{"linear", "wool", "acrylic_knit"};
  return fabrics;
}

std::vector<TradeOffCaseName> tradeOffCases(const std::vector<std::string>& fabrics) {
  std::vector<TradeOffCaseName> cases;
  for (const Motion motion :
       {Motion::kSwing, Motion::kStretch, Motion::kHang, Motion::kDrape, Motion::kFold}) {
    for (const std::string& fabric : fabrics) cases.push_back({motion, fabric});
  }
  return cases;
}

TradeOffCase loadCase(const TradeOffCaseName& name, const std::string& config) {
  return {name.motion, material::loadFabric(config + "/fabrics/" + name.fabric + ".yaml")};
}

std::vector<TradeOffPoint> tradeOffPoints() {
  std::vector<TradeOffPoint> points;
  addFine(points);  // those that take long first
  addThicknesses(points);
  addSolvers(points);
  addModels(points);
  addGrid(points);
  addExplicit(points);
  return points;
}

}  // namespace haptex::studies
