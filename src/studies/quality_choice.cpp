#include "haptex/studies/quality_choice.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>

namespace haptex::studies {
namespace {

using scene::Quality;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

bool mayBePreset(const TradeOffPoint& point) {
  return point.elasticity == cloth::Elasticity::kGreenLagrange && isImplicit(point.step.method) &&
         point.cellSize() <= kMaxCell;
}

/// The indices of a fabric's cases.
std::vector<std::size_t> casesOf(const TradeOffTable& table, const std::string& fabric) {
  std::vector<std::size_t> cases;
  for (std::size_t i = 0; i < table.cases.size(); ++i) {
    if (table.cases[i].fabric.name == fabric) cases.push_back(i);
  }
  return cases;
}

std::vector<std::string> fabricsOf(const TradeOffTable& table) {
  std::vector<std::string> fabrics;
  for (const TradeOffCase& of : table.cases) {
    const std::string& name = of.fabric.name;
    if (std::find(fabrics.begin(), fabrics.end(), name) == fabrics.end()) fabrics.push_back(name);
  }
  return fabrics;
}

Quality qualityOf(const TradeOffTable& table, std::size_t point, const std::string& fabric) {
  const TradeOffPoint& settings = table.points[point];
  Quality quality;
  quality.fabric = fabric;
  quality.cell_size = settings.cellSize();
  quality.time_step = settings.timeStep();
  quality.step = settings.step;
  for (std::size_t i = 0; i < table.cases.size(); ++i) {
    const TradeOffResult& result = table.results[point][i];
    if (!result.followed || !result.stable) continue;
    quality.measured.push_back({nameOf(table.cases[i].motion), table.cases[i].fabric.name,
                                result.error.position, result.error.force, result.error.energy,
                                result.cost});
  }
  return quality;
}

/// Points of the front, each at least kMinGain more accurate than the one kept before.
std::vector<std::size_t> usefulFront(const std::vector<CostAndError>& points) {
  std::vector<std::size_t> kept;
  for (std::size_t i : paretoFront(points)) {
    if (kept.empty() || points[i].error * kMinGain <= points[kept.back()].error) kept.push_back(i);
  }
  return kept;
}

/// Of the motions of the quality's fabric.
double worstPosition(const Quality& quality) {
  double worst = 0.0;
  for (const scene::MeasuredQuality& measured : quality.measured) {
    if (measured.fabric == quality.fabric) worst = std::max(worst, measured.position_error);
  }
  return worst;
}

/// Of those in which nothing touches the cloth.
double worstFreeCost(const Quality& quality) {
  const auto is_touched = [](const std::string& motion) {
    return std::any_of(kMotions.begin(), kMotions.end(), [&](const NamedMotion& named) {
      return motion == named.name && isTouched(named.motion);
    });
  };
  double worst = 0.0;
  for (const scene::MeasuredQuality& measured : quality.measured) {
    if (measured.fabric != quality.fabric || is_touched(measured.motion)) continue;
    worst = std::max(worst, measured.cost);
  }
  return worst;
}

void namePresets(const std::vector<CostAndError>& front, std::vector<Quality>& qualities) {
  std::size_t accurate = 0, fast = 0;
  for (std::size_t i = 0; i < front.size(); ++i) {
    if (worstFreeCost(qualities[i]) <= kMaxCost) accurate = i;
  }
  while (fast < accurate && worstPosition(qualities[fast]) > kMaxPositionError * kSampleSize) {
    ++fast;
  }
  const std::vector<CostAndError> between(front.begin() + fast, front.begin() + accurate + 1);
  const std::size_t balanced = fast + std::max<std::size_t>(1, kneeOf(between));
  for (std::size_t i = 0; i < front.size(); ++i) {
    qualities[i].name = "point_" + std::to_string(i + 1);
  }
  qualities[fast].name = "fast";
  if (balanced < accurate) qualities[balanced].name = "balanced";
  qualities[accurate].name = "accurate";
}

/// The name among the qualities for a fabric of what a point stands for, or nothing.
std::string presetOf(const TradeOffPoint& point, const std::string& fabric,
                     const std::vector<Quality>& qualities) {
  for (const Quality& quality : qualities) {
    if (quality.fabric == fabric && mayBePreset(point) && quality.cell_size == point.cellSize() &&
        quality.time_step == point.timeStep() && quality.step.method == point.step.method &&
        quality.step.solver == point.step.solver &&
        quality.step.tolerance == point.step.tolerance &&
        quality.step.newton_iterations == point.step.newton_iterations &&
        quality.step.newton_error == point.step.newton_error && point.thickness == 1.0) {
      return quality.name;
    }
  }
  return "";
}

std::vector<bool> onFront(const TradeOffTable& table, std::size_t of_case) {
  std::vector<CostAndError> points;
  for (const auto& results : table.results) {
    points.push_back(overall({results[of_case]}));
  }
  std::vector<bool> on(points.size(), false);
  for (std::size_t i : paretoFront(points)) on[i] = true;
  return on;
}

/// To 10 nm: where cells may be at most that long, there is not one more of them for rounding.
double roundedUp(double length) { return 1e-8 * std::ceil(1e8 * length - 1e-3); }

void writeErrors(std::ostream& out, const TradeOffErrors& errors) {
  out << errors.position << ',' << errors.force << ',' << errors.energy;
}

void writeResult(std::ostream& out, const TradeOffTable& table, std::size_t of_case,
                 std::size_t point, bool front, const std::string& preset) {
  const TradeOffPoint& settings = table.points[point];
  const TradeOffResult& result = table.results[point][of_case];
  out << nameOf(table.cases[of_case].motion) << ',' << table.cases[of_case].fabric.name << ','
      << nameOf(settings.elasticity) << ',' << nameOf(settings.step.method) << ','
      << settings.timeStep() << ',' << settings.cellSize() << ',';
  if (isImplicit(settings.step.method)) {
    out << settings.step.newton_iterations << ',' << settings.step.newton_error << ','
        << result.solves_per_step << ',' << nameOf(settings.step.solver) << ','
        << settings.step.tolerance << ',';
  } else {
    out << ",,,,,";
  }
  writeErrors(out, result.error);
  out << ',' << (result.distance.position < result.error.position) << ','
      << (result.distance.force < result.error.force) << ','
      << (result.distance.energy < result.error.energy) << ',' << result.relative_error << ','
      << 1e3 * result.cost << ',' << result.stable << ',' << result.settling_seconds << ',' << front
      << ',' << preset << ',' << settings.thickness << '\n';
}

}  // namespace

CostAndError overall(const std::vector<TradeOffResult>& results) {
  double cost = 0.0, error = 0.0;  // sums of logarithms
  for (const TradeOffResult& result : results) {
    if (!result.followed || !result.stable) return {kInfinite, kInfinite};
    cost += std::log(result.cost);
    error += std::log(result.relative_error);
  }
  const auto motions = static_cast<double>(results.size());
  return {std::exp(cost / motions), std::exp(error / motions)};
}

std::vector<Quality> chooseQualities(const TradeOffTable& table) {
  std::vector<Quality> chosen;
  for (const std::string& fabric : fabricsOf(table)) {
    std::vector<CostAndError> costs;
    for (std::size_t i = 0; i < table.points.size(); ++i) {
      std::vector<TradeOffResult> results;
      for (std::size_t k : casesOf(table, fabric)) results.push_back(table.results[i][k]);
      costs.push_back(mayBePreset(table.points[i]) ? overall(results)
                                                   : CostAndError{kInfinite, kInfinite});
    }
    std::vector<Quality> qualities;
    std::vector<CostAndError> front;
    for (std::size_t i : usefulFront(costs)) {
      qualities.push_back(qualityOf(table, i, fabric));
      front.push_back(costs[i]);
    }
    if (front.empty()) continue;
    namePresets(front, qualities);
    chosen.insert(chosen.end(), qualities.begin(), qualities.end());
  }
  return chosen;
}

void writeTable(std::ostream& out, const TradeOffTable& table,
                const std::vector<Quality>& qualities) {
  out << "motion,fabric,elasticity,integrator,time_step,cell_size,newton_iterations,"
         "error,solves_per_step,solver,tolerance,position_error,force_error,energy_error,"
         "position_limited,force_limited,energy_limited,relative_error,cpu_ms_per_s,stable,"
         "settling_time,front,preset,thickness\n";
  out << std::setprecision(6);
  for (std::size_t i = 0; i < table.cases.size(); ++i) {
    const Reference& reference = table.references[i];
    const TradeOffErrors& own = reference.own_error;
    out << nameOf(table.cases[i].motion) << ',' << table.cases[i].fabric.name
        << ",reference,,,,,,,,,";
    writeErrors(out, own);
    out << ",1,1,1,,,1,,0,,\n";
    const std::vector<bool> front = onFront(table, i);
    for (std::size_t k = 0; k < table.points.size(); ++k) {
      if (!table.results[k][i].followed) continue;
      writeResult(out, table, i, k, front[k],
                  presetOf(table.points[k], table.cases[i].fabric.name, qualities));
    }
  }
}

void writeQualities(std::ostream& out, const std::vector<Quality>& qualities,
                    const std::string& machine) {
  out << "# Written by scripts/update_presets; do not edit. Format: docs/quality.md\n"
      << "machine: \"" << machine << "\"\n"
      << "qualities:\n"
      << std::setprecision(4);
  for (const Quality& quality : qualities) {
    out << "  - name: " << quality.name << "\n";
    if (!quality.fabric.empty()) out << "    fabric: " << quality.fabric << "\n";
    out << "    cell_size: " << std::setprecision(9) << roundedUp(quality.cell_size) << "  # m\n"
        << "    time_step: " << quality.time_step << "  # s\n"
        << "    integrator: " << nameOf(quality.step.method) << "\n"
        << "    solver: {method: " << nameOf(quality.step.solver)
        << ", tolerance: " << quality.step.tolerance
        << ", newton_iterations: " << quality.step.newton_iterations;
    if (quality.step.newton_error > 0.0) out << ", error: " << quality.step.newton_error;
    out << "}\n"
        << "    measured:\n"
        << std::setprecision(4);
    for (const scene::MeasuredQuality& measured : quality.measured) {
      out << "      - {motion: " << measured.motion << ", fabric: " << measured.fabric
          << ", position_error: " << measured.position_error
          << ", force_error: " << measured.force_error
          << ", energy_error: " << measured.energy_error << ", cost: " << measured.cost << "}\n";
    }
  }
}

}  // namespace haptex::studies
