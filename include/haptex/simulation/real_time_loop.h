// Steps a simulated cloth in real time on a thread of its own.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <limits>
#include <mutex>
#include <optional>
#include <thread>

#include "haptex/realtime/duration_histogram.h"
#include "haptex/simulation/simulated_cloth.h"

namespace haptex::simulation {

/// How the loop is doing. Rates are over the last complete second or so and NaN before it.
struct LoopStatus {
  bool paused = false;
  bool last_step_rejected = false;
  bool asleep = false;             ///< SimulatedCloth::asleep()
  double step_rate = 0.0;          ///< accepted steps per second of the steady clock, Hz
  double real_time_factor = 0.0;   ///< simulated seconds per second of the steady clock
  double mean_step_seconds = 0.0;  ///< computing time of a step
  double largest_step_seconds = 0.0;
  double largest_residual = 0.0;        ///< relative, of all linear solves
  double dropped_seconds = 0.0;         ///< simulated time given up since the start, for lag
  std::uint64_t rejected_steps = 0;     ///< since the start
  std::uint64_t unsolved_steps = 0;     ///< since the start: tolerance of a linear solve missed
  cloth::StepReport last_report;        ///< of the last step
  AdaptiveReport last_adaptive_report;  ///< likewise
  std::uint64_t steps = 0;              ///< accepted since the start or the last reset
  double simulated_time = 0.0;          ///< s, likewise
};

/// What RealTimeLoop::runSteps() did.
struct StepsRun {
  std::uint32_t steps = 0;  ///< that were run
  enum class End { kAllRun, kRejected, kInterrupted } end = End::kAllRun;
};

/// Runs a simulation so that simulated time passes like the steady clock. Between two steps, also
/// while paused, it carries out the commands of other threads in the order they came; those that
/// come meanwhile wait for the next gap, so that neither steps nor commands starve.
///
/// Every step has a time at which it is due. When the steps take longer than they simulate, the
/// loop computes without rest and its lag grows. Beyond kMaxBacklog the simulation goes to the
/// cheapest quality that its controller knows. What exceeds the backlog after a step by that one is
/// given up and counted: simulated time falls behind, and the real-time factor shows by how much.
class RealTimeLoop {
 public:
  static constexpr double kMaxBacklog = 0.1;  ///< s

  /// Runs on the loop's thread after an accepted step, and after commands while paused or while
  /// steps are rejected.
  /// @param until_next s, >= 0, until the next step begins; kNever if none follows: the state is
  ///   the last one for a while
  using Observer = std::function<void(const SimulatedCloth&, double until_next)>;
  static constexpr double kNever = std::numeric_limits<double>::infinity();
  using Command = std::function<void(SimulatedCloth&)>;

  /// Does not start yet.
  /// @param observer must not call back into the loop
  /// @param prepare  runs on the loop's thread before every step; likewise; must not throw
  RealTimeLoop(SimulatedCloth simulation, Observer observer, Command prepare = {});
  /// Ends the thread; calls that wait for it throw.
  ~RealTimeLoop();
  RealTimeLoop(const RealTimeLoop&) = delete;
  RealTimeLoop& operator=(const RealTimeLoop&) = delete;

  void start();
  void stop();

  /// Carries out a command on the loop's thread between two steps and waits for it.
  /// @throws what the command throws, or std::runtime_error if the loop has ended
  void execute(const Command& command);

  /// Pauses or resumes. While steps are being taken, resuming interrupts them.
  /// @throws std::runtime_error if the loop has ended
  void setPaused(bool paused);

  /// Takes steps as fast as possible and waits for them. Commands are carried out between them.
  /// @param duration s of a step; nothing: the scene's
  /// @throws std::invalid_argument if the loop is not paused or already takes steps for another
  ///   caller, or as SimulatedCloth::step(), std::runtime_error if it has ended
  StepsRun runSteps(std::uint32_t count, std::optional<double> duration = {});

  LoopStatus status() const;
  /// Computing times since the start of all steps that were not slept through.
  realtime::DurationHistogram::Counts stepTimes() const { return step_times_.counts(); }

 private:
  using Clock = std::chrono::steady_clock;

  struct Request {
    const Command* command;
    std::exception_ptr error;
    bool done = false;
  };

  void run();
  bool carryOutRequests(std::unique_lock<std::mutex>& lock);
  void runRequestedStep(std::unique_lock<std::mutex>& lock);
  void runDueStep(std::unique_lock<std::mutex>& lock);
  double step(std::unique_lock<std::mutex>& lock, bool in_real_time);
  void resume();
  void endSteps(StepsRun::End end);
  void startWindow();
  void closeWindow();
  void recordSimulation();
  void requireRunning() const;

  SimulatedCloth simulation_;  // touched by the loop's thread only
  Observer observer_;
  Command prepare_;  // may be empty
  realtime::DurationHistogram step_times_;

  mutable std::mutex mutex_;           // guards all below
  std::condition_variable wake_loop_;  // for the loop: there is something to do
  std::condition_variable wake_callers_;
  std::deque<Request*> requests_;
  bool running_ = false;
  bool steps_requested_ = false;           // a caller waits in runSteps()
  std::uint32_t steps_wanted_ = 0;         // still to be taken for it
  std::optional<double> duration_wanted_;  // s, of them
  StepsRun steps_taken_;
  Clock::time_point due_;       // of the next step
  Clock::time_point computed_;  // the last step

  LoopStatus status_;
  struct Window {  // in which rates are measured
    Clock::time_point begin;
    std::uint64_t steps = 0;
    double simulated_seconds = 0.0;
    std::uint64_t attempts = 0;  // accepted and rejected steps
    double computing_seconds = 0.0;
    double largest_step_seconds = 0.0;
    double largest_residual = 0.0;
  } window_;

  std::thread thread_;
};

}  // namespace haptex::simulation
