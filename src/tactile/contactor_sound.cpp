#include "haptex/tactile/contactor_sound.h"

#include <sndfile.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <sstream>
#include <stdexcept>

#include "haptex/tactile/drive_waveform.h"

namespace haptex::tactile {
namespace {

constexpr double kMaxSpeed = 1.0;    // m/s
constexpr double kMaxForce = 20.0;   // N
constexpr double kWay = 1.0;         // s, to or fro
constexpr double kTurning = 0.1;     // s, from speed to rest or from rest to speed
constexpr int kMiddleContactor = 8;  // second row, third column

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

struct CloseSound {
  void operator()(SNDFILE* file) const { sf_close(file); }
};

/// A file that is written sample by sample.
class SoundFile {
 public:
  explicit SoundFile(const std::string& path) : path_(path) {
    SF_INFO info{};
    info.samplerate = kSoundRate;
    info.channels = 1;
    info.format = SF_FORMAT_WAV | SF_FORMAT_PCM_16;
    file_.reset(sf_open(path.c_str(), SFM_WRITE, &info));
    if (!file_) fail();
  }
  void write(const std::vector<short>& samples) {
    const auto count = static_cast<sf_count_t>(samples.size());
    if (sf_write_short(file_.get(), samples.data(), count) != count) fail();
  }
  void close() {
    sf_write_sync(file_.get());
    if (sf_error(file_.get()) != SF_ERR_NO_ERROR) fail();
    if (sf_close(file_.release()) != 0) fail();
  }

 private:
  [[noreturn]] void fail() const {
    throw std::runtime_error(path_ + ": cannot be written: " + sf_strerror(file_.get()));
  }

  std::string path_;
  std::unique_ptr<SNDFILE, CloseSound> file_;
};

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
  constexpr double kMaxSample = 32767.0;
  SoundFile file(path);
  tactile::DriveWaveform waveform(kSoundRate);
  WrittenSound written;
  std::vector<short> samples;
  const auto add = [&](const tactile::PerChannel<double>& step) {
    tactile::ArrayAmplitudes amplitudes{};
    amplitudes[0] = step;
    samples.clear();
    for (const auto& displacements : waveform.step(amplitudes)) {
      const double displacement = displacements[0];
      written.largest = std::max(written.largest, std::abs(displacement));
      if (std::abs(displacement) > kFullScale) ++written.clipped;
      const double share = std::clamp(displacement / kFullScale, -1.0, 1.0);
      samples.push_back(static_cast<short>(std::lround(kMaxSample * share)));
    }
    written.samples += samples.size();
    file.write(samples);
  };
  for (const tactile::PerChannel<double>& step : steps) add(step);
  add({});
  file.close();
  return written;
}

}  // namespace haptex::tactile
