#include "haptex/studies/stability_map.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "haptex/cloth/dynamics/integrator.h"
#include "haptex/oracles/exact/amplification.h"
#include "haptex/studies/extreme_cloth.h"

namespace haptex::studies {
namespace {

using cloth::IntegrationMethod;

ExtremeCase tautSheet(double stiffness) {
  ExtremeCase sheet;
  sheet.taut = true;
  sheet.cells_u = sheet.cells_v = 4;
  sheet.cell = 0.01;
  sheet.weft = sheet.warp = stiffness;
  sheet.shear = 0.5 * stiffness;
  return sheet;
}

cloth::Cloth vibratingCloth(double stiffness) {
  const ExtremeCase sheet = tautSheet(stiffness);
  return clothOf(sheet, meshOf(sheet), std::nullopt);
}

/// Energy above that at rest after the steps, over that before; infinite if a step was rejected or
/// it has become a million times as much.
double energyLeft(const cloth::Cloth& cloth, cloth::ClothState state,
                  const cloth::StepSettings& settings, double time_step, int steps) {
  const double at_rest = energyOf(cloth, cloth.initialState());
  const double first = energyOf(cloth, state) - at_rest;
  cloth::Integrator integrator(cloth, settings);
  double left = 1.0;
  for (int i = 0; i < steps; ++i) {
    const bool accepted = integrator.step(cloth, state, time_step).accepted;
    left = (energyOf(cloth, state) - at_rest) / first;
    if (!accepted || !(left < 1e6)) return std::numeric_limits<double>::infinity();
  }
  return left;
}

/// The highest angular frequency (rad/s) and its shape with a largest displacement of 1.
struct HighestMode {
  double frequency;
  std::vector<Eigen::Vector3d> shape;
};

HighestMode highestMode(const cloth::Cloth& cloth) {
  std::vector<int> free, index(cloth.particleCount(), -1);
  for (int i = 0; i < static_cast<int>(cloth.particleCount()); ++i) {
    if (cloth.isAttached(i)) continue;
    index[i] = static_cast<int>(free.size());
    free.push_back(i);
  }
  const auto size = static_cast<Eigen::Index>(3 * free.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  for (const cloth::JacobianBlock& block : cloth.jacobian(cloth.initialState(), free)) {
    if (index[block.column] < 0) continue;
    const double scale = std::sqrt(cloth.masses()[block.row] * cloth.masses()[block.column]);
    matrix.block<3, 3>(3 * index[block.row], 3 * index[block.column]) = -block.by_position / scale;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  HighestMode mode{std::sqrt(solver.eigenvalues().tail<1>()[0]), {}};
  mode.shape.assign(cloth.particleCount(), Eigen::Vector3d::Zero());
  double largest = 0.0;
  for (std::size_t f = 0; f < free.size(); ++f) {
    const double root = std::sqrt(cloth.masses()[free[f]]);
    mode.shape[free[f]] =
        solver.eigenvectors().col(size - 1).segment<3>(static_cast<Eigen::Index>(3 * f)) / root;
    largest = std::max(largest, mode.shape[free[f]].norm());
  }
  for (Eigen::Vector3d& place : mode.shape) place /= largest;
  return mode;
}

template <typename Grows>
double bisect(Grows&& grows) {
  double low = 1e-3, high = 10.0;
  for (int i = 0; i < 30; ++i) {
    const double middle = std::sqrt(low * high);
    (grows(middle) ? high : low) = middle;
  }
  return low;
}

}  // namespace

const char* nameOf(Stability stability) {
  switch (stability) {
    case Stability::kKept:
      return "kept";
    case Stability::kDamped:
      return "damped";
    case Stability::kDiverged:
      break;
  }
  return "diverged";
}

StabilityCell findStability(IntegrationMethod method, int newton_iterations, double time_step,
                            double stiffness) {
  constexpr int kSteps = 50;
  constexpr double kGrowth = 4.0;
  constexpr double kKept = 0.5;
  const cloth::Cloth cloth = vibratingCloth(stiffness);
  cloth::ClothState state = cloth.initialState();
  RepeatableRandom random(1);
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    if (!cloth.attachments()[i]) state.positions[i] += 1e-5 * random.direction();
  }
  cloth::StepSettings settings;
  settings.method = method;
  settings.newton_iterations = newton_iterations;
  StabilityCell cell{time_step, stiffness, Stability::kKept, 0.0};
  cell.energy_left = energyLeft(cloth, std::move(state), settings, time_step, kSteps);
  if (cell.energy_left < kKept) cell.stability = Stability::kDamped;
  if (!(cell.energy_left <= kGrowth)) cell.stability = Stability::kDiverged;
  return cell;
}

double highestFrequency(double stiffness) {
  return highestMode(vibratingCloth(stiffness)).frequency;
}

StabilityLimit findStabilityLimit(IntegrationMethod method, double stiffness) {
  constexpr int kSteps = 1000;
  constexpr double kGrowth = 1e5;
  constexpr double kAmplitude = 1e-7;  // m, far inside of the linear range
  StabilityLimit limit{};
  limit.theory = bisect(
      [&](double x) { return std::pow(oracles::amplification(method, x), 2 * kSteps) > kGrowth; });
  const cloth::Cloth cloth = vibratingCloth(stiffness);
  const HighestMode mode = highestMode(cloth);
  cloth::ClothState state = cloth.initialState();
  for (std::size_t i = 0; i < cloth.particleCount(); ++i) {
    state.positions[i] += kAmplitude * mode.shape[i];
  }
  cloth::StepSettings settings;
  settings.method = method;
  limit.measured = bisect([&](double x) {
    return energyLeft(cloth, state, settings, x / mode.frequency, kSteps) > kGrowth;
  });
  return limit;
}

}  // namespace haptex::studies
