#include "haptex/tactile/contactor_sound.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "haptex/tactile/drive_waveform.h"

namespace haptex::tactile {
namespace {

constexpr double kMaxSpeed = 1.0;   // m/s
constexpr double kMaxForce = 20.0;  // N
constexpr double kWay = 1.0;        // s, to or fro
constexpr double kTurning = 0.1;    // s, from speed to rest or from rest to speed

[[noreturn]] void refuse(const std::string& what, double value, const std::string& allowed) {
  std::ostringstream message;
  message << what << " is " << value << ": allowed are " << allowed;
  throw std::invalid_argument(message.str());
}

void requireUpTo(const char* what, double value, double most, const char* unit) {
  if (value > 0.0 && value <= most) return;
  std::ostringstream allowed;
  allowed << "numbers above 0 up to " << most << unit;
  refuse(what, value, allowed.str());
}

void requireSound(const Rubbing& rubbing) {
  requireUpTo("the speed", rubbing.speed, kMaxSpeed, " m/s");
  requireUpTo("the force", rubbing.force, kMaxForce, " N");
  requireUpTo("the length", rubbing.seconds, kLongestSound, " s");
  if (!std::isfinite(rubbing.angle)) refuse("the angle", rubbing.angle, "finite numbers");
}

/// Share of the speed, negative on the way back.
double progress(double time) {
  const double since_turn = std::fmod(time, kWay);
  const double share = std::min({1.0, since_turn / kTurning, (kWay - since_turn) / kTurning});
  return std::fmod(time, 2.0 * kWay) < kWay ? share : -share;
}

void requireSound(const ContactorSteps& steps) {
  const double seconds = static_cast<double>(steps.size()) * kTactileStep;
  if (seconds > kLongestSound) refuse("the length", seconds, "up to 3600 s");
  for (std::size_t i = 0; i < steps.size(); ++i) {
    for (const double amplitude : steps[i]) {
      if (std::isfinite(amplitude) && amplitude >= 0.0) continue;
      refuse("an amplitude of step " + std::to_string(i), amplitude, "finite numbers >= 0 m");
    }
  }
}

}  // namespace

ContactorSteps rubbedSteps(const tactile::Surface& surface, const Rubbing& rubbing) {
  requireSound(rubbing);
  const Eigen::Vector2d direction(std::cos(rubbing.angle), std::sin(rubbing.angle));
  tactile::TouchedFabric touched;
  touched.stroke.normal_force = rubbing.force;
  touched.forces.fill(rubbing.force / tactile::kContactors);
  ContactorSteps steps;
  const auto count = static_cast<std::size_t>(std::ceil(rubbing.seconds / kTactileStep));
  for (std::size_t i = 0; i < count; ++i) {
    const double middle = (static_cast<double>(i) + 0.5) * kTactileStep;
    touched.stroke.velocity = rubbing.speed * progress(middle) * direction;
    touched.placement.origin += kTactileStep * touched.stroke.velocity;
    steps.push_back(tactile::arrayAmplitudes(surface, touched, {})[kMiddleContactor]);
  }
  return steps;
}

WrittenSound writeSound(const std::string& path, const ContactorSteps& steps) {
  requireSound(steps);
  SoundFile file(path);
  tactile::DriveWaveform waveform(kSoundRate);
  const auto add = [&](const tactile::PerChannel<double>& step) {
    tactile::ArrayAmplitudes amplitudes{};
    amplitudes[0] = step;
    for (const auto& displacements : waveform.step(amplitudes)) file.add(displacements[0]);
    file.write();
  };
  for (const tactile::PerChannel<double>& step : steps) add(step);
  add({});
  file.close();
  return file.written();
}

}  // namespace haptex::tactile
