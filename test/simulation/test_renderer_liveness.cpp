#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "haptex/simulation/renderer_liveness.h"

namespace haptex::simulation::test_renderer_liveness {
namespace {

using base::Finger;
using base::kFingers;
using base::Time;
using namespace std::chrono_literals;

constexpr Time kPeriod = 1ms;
constexpr Time kDeadline = 20ms;  // of the issue: from the last sign of a source to zero force

/// Sources that send as the real ones do, each until it is killed, and a loop that looks at them.
class Sources {
 public:
  Time now() const { return now_; }
  RendererNews& news() { return news_; }
  RendererLiveness& liveness() { return liveness_; }
  void kill(RendererSource source) { dead_[static_cast<std::size_t>(source)] = true; }
  void revive(RendererSource source) { dead_[static_cast<std::size_t>(source)] = false; }
  double gain() const { return liveness_.gain(Finger::kIndex); }

  void tick() {
    now_ += kPeriod;
    const auto comes = [&](RendererSource source, Time every) {
      return !dead_[static_cast<std::size_t>(source)] && now_ % every == 0ms;
    };
    if (comes(RendererSource::kHeartbeat, 5ms)) news_.heartbeat = now_;
    if (comes(RendererSource::kClothState, 12ms)) news_.cloth_state = now_;
    news_.cloth_period = 12ms;
    if (comes(RendererSource::kHandBase, 10ms)) news_.hand_base = now_;
    for (const Finger finger : kFingers) {
      if (finger == Finger::kThumb || comes(RendererSource::kFingertip, 1ms)) {
        news_.fingertips[finger] = now_;
      }
    }
    // A question every 6 ms, answered after 1 ms.
    if (now_ % 6ms == 0ms && !news_.question) news_.question = now_;
    if (comes(RendererSource::kProximity, 1ms) && news_.question && now_ > *news_.question) {
      news_.question.reset();
      news_.proximity_answered = true;
    }
    news_.layer_ready = comes(RendererSource::kLayer, 1ms);
    liveness_.update(news_, now_);
  }
  void run(Time duration) {
    for (Time passed{0}; passed < duration; passed += kPeriod) tick();
  }

 private:
  Time now_ = 1s;
  RendererNews news_;
  RendererLiveness liveness_;
  std::array<bool, kRendererSourceCount> dead_{};
};

Sources living() {
  Sources sources;
  sources.run(200ms);
  EXPECT_EQ(sources.gain(), 1.0);
  return sources;
}

TEST(RendererLiveness, NoForceBeforeAnythingHasCome) {
  RendererLiveness liveness;
  for (int i = 0; i < 100; ++i) liveness.update(RendererNews(), 1s + i * kPeriod);
  for (const Finger finger : kFingers) EXPECT_EQ(liveness.gain(finger), 0.0);
}

TEST(RendererLiveness, NoForce20MillisecondsAfterASourceWasKilled) {
  for (const RendererSource source : {RendererSource::kHeartbeat, RendererSource::kProximity,
                                      RendererSource::kFingertip, RendererSource::kLayer}) {
    // At every moment between two of its signs.
    for (int moment = 0; moment < 12; ++moment) {
      Sources sources = living();
      sources.run(moment * kPeriod);
      sources.kill(source);
      const Time killed = sources.now();
      while (sources.gain() > 0.0 && sources.now() < killed + 1s) sources.tick();
      EXPECT_LE(sources.now() - killed, kDeadline) << name(source) << ", " << moment << " ms";
      sources.run(100ms);
      EXPECT_EQ(sources.gain(), 0.0) << name(source);
    }
  }
}

TEST(RendererLiveness, SourcesThatComeSeldomFallSilentAfterThreePeriods) {
  for (const RendererSource source : {RendererSource::kClothState, RendererSource::kHandBase}) {
    Sources sources = living();
    sources.kill(source);
    sources.run(20ms);
    EXPECT_EQ(sources.gain(), 1.0) << name(source);
    sources.run(3 * 12ms + RendererLiveness::kHandBasePatience);
    EXPECT_EQ(sources.gain(), 0.0) << name(source);
  }
}

TEST(RendererLiveness, FallsAndRisesWithoutAJump) {
  Sources sources = living();
  double before = sources.gain();
  const auto steps_of_at_most = [&](double largest, Time duration) {
    for (Time passed{0}; passed < duration; passed += kPeriod) {
      sources.tick();
      EXPECT_LE(std::abs(sources.gain() - before), largest + 1e-12);
      before = sources.gain();
    }
  };
  sources.kill(RendererSource::kHeartbeat);
  steps_of_at_most(1.0 / 4.0, 50ms);  // zero within 4 ms
  EXPECT_EQ(sources.gain(), 0.0);
  sources.revive(RendererSource::kHeartbeat);
  // Heard again after 5 ms at most, settled after 15 ms, full after 35 ms more.
  steps_of_at_most(0.0, 15ms);
  steps_of_at_most(1.0 / 35.0, 30ms);
  EXPECT_LT(sources.gain(), 1.0);
  EXPECT_GT(sources.gain(), 0.5);
  steps_of_at_most(1.0 / 35.0, 12ms);
  EXPECT_EQ(sources.gain(), 1.0);
}

TEST(RendererLiveness, AFingerThatIsSilentLeavesTheOtherItsForce) {
  Sources sources = living();
  sources.kill(RendererSource::kFingertip);  // of the index
  sources.run(30ms);
  EXPECT_EQ(sources.liveness().gain(Finger::kIndex), 0.0);
  EXPECT_EQ(sources.liveness().gain(Finger::kThumb), 1.0);
  EXPECT_TRUE(sources.liveness().isSilent(Finger::kIndex, RendererSource::kFingertip));
  EXPECT_FALSE(sources.liveness().isSilent(Finger::kThumb, RendererSource::kFingertip));
}

TEST(RendererLiveness, AStaticTransformNeedsNotComeAgain) {
  Sources sources = living();
  sources.news().hand_base_fixed = true;
  sources.kill(RendererSource::kHandBase);
  sources.run(500ms);
  EXPECT_EQ(sources.gain(), 1.0);
}

TEST(RendererLiveness, WithoutPatchesNobodyHasToAnswer) {
  Sources sources = living();
  sources.news().proximity_needed = false;
  sources.kill(RendererSource::kProximity);
  sources.run(500ms);
  EXPECT_EQ(sources.gain(), 1.0);
}

TEST(RendererLiveness, ALoopThatStoodStillGivesWhatCameMeanwhileTheTimeToBeHeard) {
  Sources sources = living();
  RendererNews news = sources.news();
  const Time stood = sources.now() + 15ms;  // nothing was heard meanwhile, for nobody listened
  sources.liveness().update(news, stood);
  EXPECT_EQ(sources.gain(), 0.75);  // 1 ms of the 4 ms to zero
}

TEST(RendererLiveness, RestartsFromZero) {
  Sources sources = living();
  sources.liveness().restart();
  EXPECT_EQ(sources.gain(), 0.0);
  sources.run(15ms);
  EXPECT_EQ(sources.gain(), 0.0);
  sources.run(1ms);
  EXPECT_NEAR(sources.gain(), 1.0 / 35.0, 1e-12);
}

TEST(RendererLiveness, RisesAtOnceAfterAHiccupThatDidNotTakeTheWholeForce) {
  Sources sources = living();
  sources.kill(RendererSource::kFingertip);
  while (sources.gain() == 1.0) sources.tick();
  const double least = sources.gain();
  EXPECT_GE(least, 0.75);
  sources.revive(RendererSource::kFingertip);
  sources.run(2ms);
  EXPECT_GT(sources.gain(), least);
  sources.run(2ms);
  EXPECT_EQ(sources.gain(), 1.0)
      << "a fifth is back within as many milliseconds as it took to fall";
}

TEST(RendererLiveness, MessagesThatAreElevenMillisecondsLateAreHardlyFelt) {
  for (const RendererSource source :
       {RendererSource::kHeartbeat, RendererSource::kProximity, RendererSource::kFingertip}) {
    for (int moment = 0; moment < 30; ++moment) {
      Sources sources = living();
      sources.run(moment * kPeriod);
      sources.kill(source);
      double sum = 0.0, least = 1.0;
      const auto watch = [&](Time duration) {
        for (Time passed{0}; passed < duration; passed += kPeriod) {
          sources.tick();
          sum += 1.0 - sources.gain();
          least = std::min(least, sources.gain());
        }
      };
      watch(11ms);
      sources.news().heartbeat = sources.now();  // what had waited comes at once
      sources.revive(source);
      watch(60ms);
      EXPECT_GE(least, 0.5) << name(source) << ", " << moment << " ms";
      // ms of a missing force, of which the driver's filters of 4 ms let a tenth through at a time.
      EXPECT_LE(sum, 2.0) << name(source) << ", " << moment << " ms";
    }
  }
}

TEST(RendererLiveness, CountsHowOftenASourceWentSilentOnceForBothFingers) {
  Sources sources = living();
  const auto before = sources.liveness().silences(RendererSource::kHeartbeat);
  for (int i = 0; i < 3; ++i) {
    sources.kill(RendererSource::kHeartbeat);
    sources.run(30ms);
    sources.revive(RendererSource::kHeartbeat);
    sources.run(30ms);
  }
  EXPECT_EQ(sources.liveness().silences(RendererSource::kHeartbeat), before + 3);
}

TEST(RendererLiveness, SaysWhichSourceIsSilentAndForHowLong) {
  Sources sources = living();
  EXPECT_EQ(whySilent(Finger::kIndex, sources.news(), sources.now()), "");
  for (const RendererSource source : kRendererSources) {
    Sources dying = living();
    dying.kill(source);
    dying.run(200ms);
    const std::string why = whySilent(Finger::kIndex, dying.news(), dying.now());
    EXPECT_NE(why.find(name(source)), std::string::npos) << why;
    EXPECT_EQ(why.find(';'), std::string::npos) << "another one is named too: " << why;
  }
  const std::string all = whySilent(Finger::kIndex, RendererNews(), 1s);
  for (const RendererSource source : kRendererSources) {
    EXPECT_NE(all.find(name(source)), std::string::npos) << all;
  }
}

}  // namespace
}  // namespace haptex::simulation::test_renderer_liveness
