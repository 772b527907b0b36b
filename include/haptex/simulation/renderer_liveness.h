// Whether everything that forces are computed from lives, and how much of the forces is rendered.
// Knows no ROS and reads no clock.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "haptex/base/clock.h"
#include "haptex/base/finger.h"

namespace haptex::simulation {

/// What the force on a finger is computed from.
enum class RendererSource {
  kHeartbeat,   ///< cloth/heartbeat
  kClothState,  ///< cloth/state
  kProximity,   ///< answers of proximity/query
  kHandBase,    ///< the transform of hand_base to world
  kFingertip,   ///< measured_cp and measured_cv of the finger
  kLayer,       ///< the small-scale layer, made of mesh and fabric
};
constexpr std::size_t kRendererSourceCount = 6;
constexpr std::array<RendererSource, kRendererSourceCount> kRendererSources{
    RendererSource::kHeartbeat, RendererSource::kClothState, RendererSource::kProximity,
    RendererSource::kHandBase,  RendererSource::kFingertip,  RendererSource::kLayer};

/// In a few words, for diagnostics.
const char* name(RendererSource source);

/// When each source was heard last, by the arrival of its messages on the steady clock: stamps are
/// another machine's, and a publisher that died is still counted as one for a long time.
struct RendererNews {
  using Time = base::Time;

  std::optional<Time> heartbeat;
  std::optional<Time> cloth_state;
  Time cloth_period{0};  ///< of simulated time, between the last two states
  bool proximity_needed = true;
  bool proximity_answered = false;  ///< the last query; false before the first
  std::optional<Time> question;     ///< when it was asked what is not answered yet
  std::optional<Time> hand_base;
  bool hand_base_fixed = false;  ///< a static transform, which never comes again
  base::PerFinger<std::optional<Time>> fingertips;
  bool layer_ready = false;
};

/// Whether a source has been silent for so long that no force may be computed from it.
bool isSilent(RendererSource source, base::Finger finger, const RendererNews& news, base::Time now);

/// Which sources of a finger are silent and for how long; empty if none is.
std::string whySilent(base::Finger finger, const RendererNews& news, base::Time now);

/// The share of each finger's forces that is rendered. While a source is late the forces go on from
/// what it said last, so that a message that comes 10 ms late is not felt; when it has been silent
/// for its patience the share falls to zero within kFall. When all live (again) it rises: from zero
/// within kRise, and when they have lived for kSettle, because a fingertip that appears within the
/// cloth has then displaced it; where it had not fallen to zero, within kResume. Allocates nothing.
///
/// A source that is killed is noticed 15 ms after its last sign at the latest, the hand base
/// excepted; with kFall and a period all forces are zero 20 ms after it.
class RendererLiveness {
 public:
  using Time = base::Time;

  static constexpr Time kHeartbeatPatience = std::chrono::milliseconds(15);
  /// In periods of the states, and not below that of the heartbeat.
  static constexpr int kStatePatience = 3;
  /// For an answer. A connection that breaks is noticed at once; this is for a server that hangs,
  /// which is asked something at least every 6 ms.
  static constexpr Time kProximityPatience = std::chrono::milliseconds(9);
  /// Three periods of a tracker of 60 Hz.
  static constexpr Time kHandBasePatience = std::chrono::milliseconds(50);
  static constexpr Time kFingertipPatience = std::chrono::milliseconds(15);
  static constexpr Time kFall = std::chrono::milliseconds(4);
  static constexpr Time kSettle = std::chrono::milliseconds(15);
  static constexpr Time kRise = std::chrono::milliseconds(35);
  static constexpr Time kResume = std::chrono::milliseconds(8);
  /// A loop that stood still for longer has not heard what came meanwhile: it counts as this long.
  static constexpr Time kLongestPeriod = std::chrono::milliseconds(1);

  /// Once per period of the loop.
  void update(const RendererNews& news, Time now);

  /// The forces jump for another reason: start again from zero.
  void restart();

  /// 0 to 1, no unit.
  double gain(base::Finger finger) const { return gains_[finger]; }
  /// At the last update.
  bool isSilent(base::Finger finger, RendererSource source) const {
    return silent_[finger][static_cast<std::size_t>(source)];
  }
  /// How often a source that lived went silent, for any finger.
  std::uint64_t silences(RendererSource source) const {
    return silences_[static_cast<std::size_t>(source)];
  }

 private:
  std::optional<Time> last_update_;
  base::PerFinger<double> gains_;
  base::PerFinger<bool> from_zero_{{{true, true}}};  ///< not risen to one since
  base::PerFinger<std::optional<Time>> alive_since_;
  base::PerFinger<std::array<bool, kRendererSourceCount>> silent_{};
  std::array<std::uint64_t, kRendererSourceCount> silences_{};
};

}  // namespace haptex::simulation
