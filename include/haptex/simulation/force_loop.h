// The force renderer without ROS: what happens once per millisecond between what is known of cloth
// and fingers and the forces on both.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "haptex/base/clock.h"
#include "haptex/base/finger.h"
#include "haptex/contact/contactors.h"
#include "haptex/contact/haptic_layer.h"
#include "haptex/realtime/handover.h"
#include "haptex/realtime/semaphore.h"
#include "haptex/realtime/triple_buffer.h"
#include "haptex/simulation/fingertip_motion.h"
#include "haptex/simulation/frame_follower.h"
#include "haptex/simulation/large_scale_state.h"
#include "haptex/simulation/renderer_liveness.h"

namespace haptex::simulation {

/// What the loop is to go on with. After it was taken it holds what was replaced.
struct LayerUpdate {
  bool replaces_layer = false;
  std::unique_ptr<contact::HapticLayer> layer;  ///< null: none
  std::size_t particles = 0;                    ///< of the layer's large-scale mesh
  std::uint32_t mesh = 0;                       ///< its number
  bool replaces_patch = false;                  ///< of the layer, the new one if there is one
  std::unique_ptr<contact::Patch> patch;        ///< null: none
};

/// For those who ask what is near the fingertips and tell the cloth what acts on it.
struct LoopView {
  LoopView() { loads.reserve(cloth::PointLoads::kMax); }

  std::uint64_t states = 0;    ///< of the cloth, taken so far
  std::uint64_t loadings = 0;  ///< times that the loads were due to be sent, so far
  double state_period = 0.0;   ///< s, of simulated time, between the last two
  /// Where they were last, or the cloth holds them; also of one that is silent: its patch stays for
  /// when it is back.
  contact::Fingertips fingertips;
  std::vector<cloth::PointLoad> loads;
  bool is_pinched = false;  ///< HapticLayer::isPinched()
  std::uint32_t mesh = 0;   ///< number of the one that they are on
  double load_gain = 0.0;   ///< share of them that is to act
};

/// The loads that are to act: times their gain, none without.
void fillActingLoads(const LoopView& view, std::vector<cloth::PointLoad>& loads);

/// For markers.
struct ContactPicture {
  static constexpr std::size_t kMaxParticles = 8192;  ///< a patch with more is not shown

  ContactPicture();

  base::PerFinger<contact::FingertipContact> contacts;
  base::PerFinger<double> gains;
  // Of the patch.
  std::vector<Eigen::Vector3d> positions;  ///< m, world frame
  std::vector<std::array<int, 3>> triangles;
  std::vector<double> contact_forces;  ///< N, per particle
};

/// For diagnostics.
struct ForceLoopStatus {
  struct OfFinger {
    double gain = 0.0;
    bool touching = false;
    double force = 0.0;         ///< N, rendered
    double normal_force = 0.0;  ///< N, rendered
  };
  RendererNews news;
  base::PerFinger<OfFinger> fingers;
  std::array<std::uint64_t, kRendererSourceCount> silences{};  ///< see RendererLiveness
  std::size_t patch_particles = 0;
  // Counts since the construction.
  std::uint64_t ticks = 0;
  std::uint64_t states = 0;          ///< of the cloth, taken
  std::uint64_t other_sizes = 0;     ///< states that do not fit the mesh, not taken
  std::uint64_t patches = 0;         ///< exchanged
  std::uint64_t rejected_steps = 0;  ///< that were not finite
};

/// One thread ticks; it does not wait, allocate or free. Any bring poses, velocities and
/// heartbeats, one other thread brings what else comes in, one gives layers and patches, any may
/// look.
class ForceLoop {
 public:
  using Time = base::Time;
  using Finger = base::Finger;
  static constexpr Time kPeriod = std::chrono::milliseconds(1);
  /// How long before the cloth's next step its loads are sent, once per state: the younger they
  /// are, the less the force errs (scripts/bench trade_off_haptic), and what comes too late acts a
  /// step later.
  static constexpr Time kLoadLead = std::chrono::milliseconds(3);

  /// What came of a tick for a finger.
  struct Rendered {
    contact::FingertipContact contact;
    tactile::PerContactor<double> contactor_forces{};  ///< N
    tactile::ArrayPlacement array;                     ///< on the fabric, zero without contact
    Time measured{0};   ///< stamp of the pose that it was computed from, see receivePose()
    double gain = 0.0;  ///< share of the contact's force that is to be rendered, 0 to 1
  };

  /// Times are those of steadyNow(). @param radii of the fingertips, m, > 0
  explicit ForceLoop(const base::PerFinger<double>& radii);

  // Only what is believed. Arrivals are when the messages came.
  /// By any thread. @param measured its stamp, by any clock, to be told with the force that comes
  /// of it
  void receivePose(Finger finger, const Eigen::Isometry3d& in_hand_base, Time arrival,
                   Time measured = Time{0});
  /// By any thread.
  void receiveTwist(Finger finger, const FingertipTwist& in_hand_base, Time arrival);
  void receiveHeartbeat(Time arrival);

  // By the thread of what else comes in.
  /// @param time when the hand was there @param fixed a static transform
  void receiveHandBase(const Eigen::Isometry3d& in_world, Time time, Time arrival, bool fixed);
  void receiveState(const LargeScaleState& state, Time arrival);
  /// Pose of the contactor array in the fingertip's frame; without it what is of the array
  /// is zero.
  void receiveArray(Finger finger, const Eigen::Isometry3d& in_fingertip);

  // By the thread of layers and patches.
  bool canOffer() { return updates_.isFree(); }
  void offer(std::unique_ptr<LayerUpdate> update) { updates_.offer(std::move(update)); }
  /// Whether the layer belongs to the present mesh and fabric.
  void setLayerReady(bool ready) { layer_ready_ = ready; }
  void reportQuestion(Time asked) { question_ = asked.count(); }
  /// @param good false: refused, or there is nobody who answers
  void reportAnswer(bool good);
  /// Waits until a state of the cloth has been taken or loads are due. @returns false if neither
  /// was in time
  bool waitForNews(Time patience) { return news_came_.waitFor(patience); }
  const LoopView& view();

  /// By one thread, once per kPeriod, and by it before: whether anybody looks at what is of the
  /// contactors; at first somebody does.
  void wantContactors(Finger finger, bool wanted) { contactors_wanted_[finger] = wanted; }
  void tick(Time now);
  /// By the same thread, of the last tick.
  const Rendered& rendered(Finger finger) const { return rendered_[finger]; }
  const FrameMotion& hand() const { return hand_; }
  /// By the same thread; null without one.
  const contact::HapticLayer* layer() const { return layer_.get(); }

  /// By any thread.
  ForceLoopStatus status() const;
  /// By one thread: the newest picture, which comes within some periods after it was asked for.
  const ContactPicture& picture();
  void askForPicture() { picture_wanted_ = true; }

 private:
  struct Pose {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    Time arrival{0};
    Time measured{0};
    bool known = false;
  };
  struct Twist {
    FingertipTwist twist;
    Time arrival{0};
    bool known = false;
  };
  struct HandBase {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    Time time{0};
    Time arrival{0};
    bool fixed = false;
  };
  struct State {
    LargeScaleState state;
    Time arrival{0};
  };
  struct Array {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    bool known = false;
  };
  struct FingerInput {
    std::mutex writers;  // guards writing the next two; never taken by the loop
    realtime::TripleBuffer<Pose> pose;
    realtime::TripleBuffer<Twist> twist;
    realtime::TripleBuffer<Array> array;
  };

  void takeUpdate();
  bool takeClothState();
  bool isOfLayer(const LargeScaleState& state) const;
  void receiveState(double period);
  void takeFingers(Time now);
  bool isPresent(Finger finger) const;
  contact::Fingertip fingertip(Finger finger) const;
  void step();
  bool loadsAreDue(bool state_taken, Time now);
  void showView(bool has_news);
  void showPicture();
  void showStatus();
  double loadGain() const;

  const base::PerFinger<double> radii_;

  // Of the thread that ticks.
  std::unique_ptr<contact::HapticLayer> layer_;
  std::size_t layer_particles_ = 0;
  std::uint32_t layer_mesh_ = 0;
  RendererLiveness liveness_;
  RendererNews news_;
  FrameFollower follower_;
  FrameMotion hand_;
  contact::Fingertips fingertips_;
  base::PerFinger<Rendered> rendered_;
  base::PerFinger<bool> contactors_wanted_{{{true, true}}};
  std::optional<double> simulated_time_;  // of the last state taken
  double state_period_;                   // s, of simulated time
  std::optional<Time> loads_due_;         // none: sent since the last state
  LoopView view_;
  int ticks_to_view_ = 0;
  ContactPicture picture_;
  ForceLoopStatus status_;

  // To it.
  base::PerFinger<FingerInput> inputs_;
  realtime::TripleBuffer<HandBase> hand_base_;
  realtime::TripleBuffer<State> states_;
  std::atomic<std::int64_t> heartbeat_{kNever};  // ns
  std::atomic<std::int64_t> question_{kNever};   // ns, not answered yet
  std::atomic<bool> answered_{false};            // the last one
  std::atomic<bool> layer_ready_{false};
  realtime::Handover<LayerUpdate> updates_;
  std::atomic<bool> picture_wanted_{false};
  State incoming_state_;  // of the thread of what comes in

  // From it.
  realtime::Semaphore news_came_;
  realtime::TripleBuffer<LoopView> views_;
  realtime::TripleBuffer<ContactPicture> pictures_;
  mutable std::mutex status_readers_;  // guards reading; never taken by the loop
  mutable realtime::TripleBuffer<ForceLoopStatus> shown_status_;

  static constexpr std::int64_t kNever = -1;
};

}  // namespace haptex::simulation
