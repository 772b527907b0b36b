#include "haptex/simulation/renderer_liveness.h"

#include <algorithm>
#include <sstream>

namespace haptex::simulation {
namespace {

using base::Finger;
using base::Time;

/// When the source was heard last.
std::optional<Time> lastSign(RendererSource source, Finger finger, const RendererNews& news) {
  switch (source) {
    case RendererSource::kHeartbeat:
      return news.heartbeat;
    case RendererSource::kClothState:
      return news.cloth_state;
    case RendererSource::kProximity:
      return news.question;
    case RendererSource::kHandBase:
      return news.hand_base;
    case RendererSource::kFingertip:
      return news.fingertips[finger];
    case RendererSource::kLayer:
      break;
  }
  return std::nullopt;
}

Time patience(RendererSource source, const RendererNews& news) {
  using Liveness = RendererLiveness;
  switch (source) {
    case RendererSource::kHeartbeat:
      return Liveness::kHeartbeatPatience;
    case RendererSource::kClothState:
      return std::max(Liveness::kStatePatience * news.cloth_period, Liveness::kHeartbeatPatience);
    case RendererSource::kProximity:
      return Liveness::kProximityPatience;
    case RendererSource::kHandBase:
      return Liveness::kHandBasePatience;
    case RendererSource::kFingertip:
      return Liveness::kFingertipPatience;
    case RendererSource::kLayer:
      break;
  }
  return Time{0};
}

double share(Time part, Time whole) { return base::seconds(part) / base::seconds(whole); }

}  // namespace

const char* name(RendererSource source) {
  switch (source) {
    case RendererSource::kHeartbeat:
      return "cloth/heartbeat";
    case RendererSource::kClothState:
      return "cloth/state";
    case RendererSource::kProximity:
      return "proximity/query";
    case RendererSource::kHandBase:
      return "tf of hand_base";
    case RendererSource::kFingertip:
      return "pose and velocity of the fingertip";
    case RendererSource::kLayer:
      return "small-scale layer";
  }
  return "unknown";
}

bool isSilent(RendererSource source, Finger finger, const RendererNews& news, Time now) {
  if (source == RendererSource::kLayer) return !news.layer_ready;
  if (source == RendererSource::kProximity) {
    if (!news.proximity_needed) return false;
    if (!news.proximity_answered) return true;
    return news.question && now - *news.question > patience(source, news);
  }
  const std::optional<Time> last = lastSign(source, finger, news);
  if (!last) return true;
  if (source == RendererSource::kHandBase && news.hand_base_fixed) return false;
  return now - *last > patience(source, news);
}

std::string whySilent(Finger finger, const RendererNews& news, Time now) {
  std::ostringstream text;
  const char* separator = "";
  for (const RendererSource source : kRendererSources) {
    if (!isSilent(source, finger, news, now)) continue;
    text << separator << name(source) << ": ";
    separator = "; ";
    const std::optional<Time> last = lastSign(source, finger, news);
    if (source == RendererSource::kLayer) {
      text << "there is none yet for this mesh and fabric";
    } else if (source == RendererSource::kProximity && !news.proximity_answered) {
      text << "no query has been answered";
    } else if (!last) {
      text << "nothing has come yet";
    } else {
      text << "nothing for " << 1e3 * base::seconds(now - *last) << " ms, allowed are "
           << 1e3 * base::seconds(patience(source, news)) << " ms";
    }
  }
  return text.str();
}

void RendererLiveness::update(const RendererNews& news, Time now) {
  const Time elapsed =
      last_update_ ? std::clamp(now - *last_update_, Time{0}, kLongestPeriod) : Time{0};
  std::array<bool, kRendererSourceCount> fell_silent{};
  for (const Finger finger : base::kFingers) {
    bool all_live = true;
    for (const RendererSource source : kRendererSources) {
      const auto index = static_cast<std::size_t>(source);
      const bool silent = simulation::isSilent(source, finger, news, now);
      fell_silent[index] |= last_update_ && silent && !silent_[finger][index];
      silent_[finger][index] = silent;
      all_live = all_live && !silent;
    }
    std::optional<Time>& since = alive_since_[finger];
    if (!all_live) {
      since.reset();
    } else if (!since) {
      since = now;
    }
    const bool settles = all_live && gains_[finger] == 0.0 && now - *since < kSettle;
    const double rise = settles ? 0.0 : share(elapsed, from_zero_[finger] ? kRise : kResume);
    gains_[finger] =
        std::clamp(gains_[finger] + (all_live ? rise : -share(elapsed, kFall)), 0.0, 1.0);
    if (gains_[finger] == 0.0) from_zero_[finger] = true;
    if (gains_[finger] == 1.0) from_zero_[finger] = false;
  }
  for (std::size_t i = 0; i < kRendererSourceCount; ++i) silences_[i] += fell_silent[i] ? 1 : 0;
  last_update_ = now;
}

void RendererLiveness::restart() {
  for (const Finger finger : base::kFingers) {
    gains_[finger] = 0.0;
    from_zero_[finger] = true;
    alive_since_[finger].reset();
  }
}

}  // namespace haptex::simulation
