#include "haptex/studies/haptic_trade_off.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "haptex/base/quantity.h"
#include "haptex/simulation/step_cost.h"

namespace haptex::studies {
namespace {

using base::Finger;
using base::kFingers;
using Eigen::Vector3d;
// From a cell of the reference's mesh to the next, away from the fingertip: what is smooth there
// needs cells in proportion to the distance.
constexpr double kGrowth = 1.25;

using Forces = base::PerFinger<Vector3d>;

/// How many times `part` fits into `whole`.
int wholeMultiple(const char* name, double whole, double part) {
  const double times = std::round(whole / part);
  if (!std::isfinite(whole) || !(times >= 1.0) || std::abs(whole / part - times) > 1e-6) {
    std::ostringstream message;
    message << "trade-off: " << name << ' ' << whole << " s must be a whole multiple of " << part
            << " s";
    throw std::invalid_argument(message.str());
  }
  return static_cast<int>(times);
}

int fingertipsOf(const oracles::PrescribedTouch& touch) {
  const oracles::Fingertips fingertips = touch.fingertips(0.0);
  return static_cast<int>(std::count_if(fingertips.values.begin(), fingertips.values.end(),
                                        [](const auto& tip) { return tip.has_value(); }));
}

/// Differences of forces over the records of a touch.
class Differences {
 public:
  explicit Differences(int fingertips) : fingertips_(fingertips) {}

  void add(const Forces& forces, const Forces& others) {
    for (const Finger finger : kFingers) {
      const double difference = (forces[finger] - others[finger]).norm();
      squares_ += difference * difference;
      worst_ = base::largerOrNaN(worst_, difference);
    }
    ++records_;
  }
  double rootMeanSquare() const { return std::sqrt(squares_ / (records_ * fingertips_)); }
  double worst() const { return worst_; }

 private:
  int fingertips_;
  int records_ = 0;
  double squares_ = 0.0;
  double worst_ = 0.0;
};

/// What the driver makes of the last tick for a fingertip that has moved on.
Forces rendered(const contact::HapticLayer& layer, const oracles::Fingertips& now) {
  Forces forces{{Vector3d::Zero(), Vector3d::Zero()}};
  for (const Finger finger : kFingers) {
    const contact::FingertipContact& contact = layer.contacts()[finger];
    if (!contact.touching || !now[finger]) continue;
    forces[finger] = contact.force -
                     contact.stiffness * (now[finger]->position - contact.position) -
                     contact.damping * (now[finger]->velocity - contact.velocity);
  }
  return forces;
}

double medianOf(std::vector<double>& times) {
  if (times.empty()) return 0.0;
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::nth_element(times.begin(), middle, times.end());
  return *middle;
}

}  // namespace

TouchReference computeReference(const oracles::PrescribedTouch& touch, double cell,
                                int steps_per_record) {
  if (steps_per_record < 2 || steps_per_record % 2 != 0) {
    throw std::invalid_argument("trade-off: steps_per_record " + std::to_string(steps_per_record) +
                                " must be even and >= 2");
  }
  TouchReference reference;
  reference.record = oracles::computeInOneLayer(touch, cell, kGrowth, steps_per_record);
  const oracles::ForceRecord half =
      oracles::computeInOneLayer(touch, 2.0 * cell, kGrowth * kGrowth, steps_per_record / 2);
  Differences from_half(fingertipsOf(touch)), from_zero(fingertipsOf(touch));
  for (std::size_t i = 0; i < half.forces.size(); ++i) {
    from_half.add(reference.record.forces[i], half.forces[i]);
    from_zero.add(reference.record.forces[i], {{Vector3d::Zero(), Vector3d::Zero()}});
  }
  reference.force = from_zero.rootMeanSquare();
  reference.error = from_half.rootMeanSquare();
  reference.worst_error = from_half.worst();
  return reference;
}

HapticCost measureTouch(const oracles::PrescribedTouch& touch, const HapticPoint& point,
                        const TouchReference& reference) {
  const double h = point.haptics.time_step;
  const int records_per_tick = wholeMultiple("time_step", h, reference.record.interval);
  const int ticks_per_step = wholeMultiple("large_scale_step", point.large_scale_step, h);
  const int ticks = wholeMultiple("duration", touch.duration, h);
  if (reference.record.forces.size() != static_cast<std::size_t>(ticks) * records_per_tick) {
    throw std::invalid_argument("trade-off: the reference has " +
                                std::to_string(reference.record.forces.size()) + " records; " +
                                touch.name + " needs " + std::to_string(ticks * records_per_tick));
  }
  oracles::HapticLoopSettings settings = touch.sample;
  settings.haptics = point.haptics;
  settings.large_scale_step = point.large_scale_step;
  oracles::HapticLoop loop(settings);

  Differences all(fingertipsOf(touch)), at_rest(fingertipsOf(touch));
  const double rest_from = 0.5 * (touch.rest_from + touch.duration);
  std::vector<double> tick_times;
  double total_time = 0.0;
  for (int tick = 1; tick <= ticks; ++tick) {
    const oracles::Fingertips fingertips = touch.fingertips(tick * h);
    const double begin = simulation::threadSeconds();
    loop.step(fingertips);
    const double taken = simulation::threadSeconds() - begin;
    total_time += taken;
    const bool alone = (tick - 1) % ticks_per_step != 0;  // without a large-scale step
    if (alone && loop.layer().particleCount() > 0) tick_times.push_back(taken);
    for (int k = 0; k < records_per_tick; ++k) {
      const std::size_t record = static_cast<std::size_t>(tick) * records_per_tick - 1 + k;
      if (record >= reference.record.forces.size()) break;
      const double time = (record + 1) * reference.record.interval;
      const Forces forces = rendered(loop.layer(), touch.fingertips(time));
      all.add(forces, reference.record.forces[record]);
      if (time > rest_from) at_rest.add(forces, reference.record.forces[record]);
    }
  }
  HapticCost cost;
  cost.force_error = all.rootMeanSquare();
  cost.worst_error = all.worst();
  cost.rest_error = at_rest.rootMeanSquare();
  cost.particles = loop.layer().particleCount();
  cost.rejected_steps = loop.rejectedSteps();
  cost.tick_time = medianOf(tick_times);
  cost.large_scale_time = (total_time - ticks * cost.tick_time) / touch.duration;
  return cost;
}

std::vector<char> isDominated(const std::vector<ErrorAndTime>& points) {
  std::vector<char> dominated;
  for (const ErrorAndTime& point : points) {
    dominated.push_back(std::any_of(points.begin(), points.end(), [&](const ErrorAndTime& other) {
      return other.error <= point.error && other.time <= point.time &&
             (other.error < point.error || other.time < point.time);
    }));
  }
  return dominated;
}

}  // namespace haptex::studies
