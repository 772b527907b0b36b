#include "haptex/simulation/real_time_loop.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "haptex/realtime/scheduling.h"

namespace haptex::simulation {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::chrono::seconds kWindowLength{1};

std::chrono::steady_clock::duration clockDuration(double seconds) {
  return std::chrono::duration_cast<std::chrono::steady_clock::duration>(
      std::chrono::duration<double>(seconds));
}

double inSeconds(std::chrono::steady_clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

}  // namespace

RealTimeLoop::RealTimeLoop(SimulatedCloth simulation, Observer observer, Command prepare)
    : simulation_(std::move(simulation)),
      observer_(std::move(observer)),
      prepare_(std::move(prepare)) {
  startWindow();
}

RealTimeLoop::~RealTimeLoop() { stop(); }

void RealTimeLoop::start() {
  running_ = true;
  thread_ = std::thread([this] { run(); });
  realtime::keepOffForceProcessor(thread_.native_handle());
}

void RealTimeLoop::stop() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    running_ = false;
  }
  wake_loop_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void RealTimeLoop::execute(const Command& command) {
  Request request{&command, nullptr};
  std::unique_lock<std::mutex> lock(mutex_);
  requireRunning();
  requests_.push_back(&request);
  wake_loop_.notify_all();
  wake_callers_.wait(lock, [&] { return request.done; });
  if (request.error) std::rethrow_exception(request.error);
}

void RealTimeLoop::setPaused(bool paused) {
  // As a command, so that no step is under way any more when this returns.
  execute([this, paused](SimulatedCloth&) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (paused == status_.paused) return;
    status_.paused = paused;
    startWindow();
    if (!paused) resume();
  });
}

StepsRun RealTimeLoop::runSteps(std::uint32_t count, std::optional<double> duration) {
  if (duration) SimulatedCloth::requireDuration(*duration);
  std::unique_lock<std::mutex> lock(mutex_);
  requireRunning();
  if (!status_.paused) {
    throw std::invalid_argument("the simulation runs: steps are allowed while it is paused");
  }
  if (steps_requested_) {
    throw std::invalid_argument("steps for another caller are being taken: allowed is one at once");
  }
  steps_requested_ = true;
  steps_taken_ = StepsRun{};
  steps_wanted_ = count;
  duration_wanted_ = duration;
  wake_loop_.notify_all();
  wake_callers_.wait(lock, [&] { return steps_wanted_ == 0; });
  steps_requested_ = false;
  return steps_taken_;
}

LoopStatus RealTimeLoop::status() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return status_;
}

void RealTimeLoop::run() {
  std::unique_lock<std::mutex> lock(mutex_);
  resume();
  while (running_) {
    const bool carried_out = carryOutRequests(lock);
    const bool rests = status_.paused ? steps_wanted_ == 0 : status_.last_step_rejected;
    if (carried_out && rests) {
      lock.unlock();
      observer_(simulation_, kNever);
      lock.lock();
    }
    const auto disturbed = [this] { return !running_ || !requests_.empty(); };
    if (!running_) break;
    if (steps_wanted_ > 0) {
      runRequestedStep(lock);
    } else if (status_.paused) {
      wake_loop_.wait(lock, [&] { return disturbed() || steps_wanted_ > 0; });
    } else if (Clock::now() >= due_) {  // before new requests, which would starve the steps
      runDueStep(lock);
    } else {
      wake_loop_.wait_until(lock, due_, disturbed);
    }
  }
  endSteps(StepsRun::End::kInterrupted);
  for (Request* request : requests_) {
    request->error = std::make_exception_ptr(std::runtime_error("the simulation has ended"));
    request->done = true;
  }
  requests_.clear();
  wake_callers_.notify_all();
}

/// Carries out the requests that are there now; those that come meanwhile wait for the next gap.
bool RealTimeLoop::carryOutRequests(std::unique_lock<std::mutex>& lock) {
  const std::size_t count = requests_.size();
  for (std::size_t i = 0; i < count; ++i) {
    Request* request = requests_.front();
    requests_.pop_front();
    lock.unlock();
    try {
      (*request->command)(simulation_);
    } catch (...) {
      request->error = std::current_exception();
    }
    lock.lock();
    recordSimulation();
    request->done = true;
    wake_callers_.notify_all();
  }
  return count > 0;
}

void RealTimeLoop::runRequestedStep(std::unique_lock<std::mutex>& lock) {
  step(lock, false);
  if (status_.last_step_rejected) {
    endSteps(StepsRun::End::kRejected);
    return;
  }
  ++steps_taken_.steps;
  if (--steps_wanted_ == 0) wake_callers_.notify_all();
}

void RealTimeLoop::runDueStep(std::unique_lock<std::mutex>& lock) {
  const bool cheapest = simulation_.runsCheapest();
  const double seconds = step(lock, true);
  const Clock::time_point now = Clock::now();
  const double simulated = simulation_.lastStepDuration();
  due_ += clockDuration(simulated);
  const Clock::duration excess = now - due_ - clockDuration(kMaxBacklog);
  if (excess > Clock::duration::zero() && !cheapest) {
    simulation_.relieve();
  } else if (excess > Clock::duration::zero()) {
    due_ += excess;
    status_.dropped_seconds += inSeconds(excess);
  }
  ++window_.attempts;
  window_.steps += status_.last_step_rejected ? 0 : 1;
  window_.simulated_seconds += status_.last_step_rejected ? 0.0 : simulated;
  window_.computing_seconds += seconds;
  window_.largest_step_seconds = std::max(window_.largest_step_seconds, seconds);
  window_.largest_residual =
      std::max(window_.largest_residual, simulation_.lastReport().linear_residual);
  if (now - window_.begin >= kWindowLength) closeWindow();
}

/// Takes a step and shows it to the observer. @returns its computing time, s
double RealTimeLoop::step(std::unique_lock<std::mutex>& lock, bool in_real_time) {
  const bool rests = steps_wanted_ == 1;
  const std::optional<double> duration = duration_wanted_;
  const Clock::time_point due = due_;
  const Clock::time_point ready = std::max(due_, computed_);
  lock.unlock();
  const Clock::time_point begin = Clock::now();
  if (prepare_) prepare_(simulation_);
  const bool slept = simulation_.asleep();
  const bool accepted = in_real_time ? simulation_.stepInRealTime(inSeconds(Clock::now() - ready))
                        : duration   ? simulation_.step(*duration)
                                     : simulation_.step();
  computed_ = Clock::now();
  const Clock::duration took = computed_ - begin;
  if (!slept) step_times_.add(took);
  if (accepted) {
    const auto next = due + clockDuration(simulation_.lastStepDuration());
    const double until_next = in_real_time ? std::max(0.0, inSeconds(next - Clock::now())) : 0.0;
    observer_(simulation_, rests ? kNever : until_next);
  }
  lock.lock();
  status_.rejected_steps += accepted ? 0 : 1;
  status_.unsolved_steps += simulation_.lastReport().linear_converged ? 0 : 1;
  recordSimulation();
  return inSeconds(took);
}

void RealTimeLoop::resume() {
  due_ = Clock::now();
  startWindow();
  if (steps_wanted_ > 0) endSteps(StepsRun::End::kInterrupted);
}

void RealTimeLoop::endSteps(StepsRun::End end) {
  if (steps_wanted_ == 0) return;
  steps_taken_.end = end;
  steps_wanted_ = 0;
  wake_callers_.notify_all();
}

void RealTimeLoop::startWindow() {
  window_ = Window{};
  window_.begin = Clock::now();
  status_.step_rate = kNaN;
  status_.real_time_factor = kNaN;
  status_.mean_step_seconds = kNaN;
  status_.largest_step_seconds = kNaN;
  status_.largest_residual = kNaN;
}

void RealTimeLoop::closeWindow() {
  const Window window = window_;
  startWindow();
  const double elapsed = inSeconds(window_.begin - window.begin);
  status_.step_rate = window.steps / elapsed;
  status_.real_time_factor = window.simulated_seconds / elapsed;
  status_.mean_step_seconds = window.computing_seconds / window.attempts;
  status_.largest_step_seconds = window.largest_step_seconds;
  status_.largest_residual = window.largest_residual;
}

void RealTimeLoop::recordSimulation() {
  status_.last_step_rejected = simulation_.lastStepRejected();
  status_.asleep = simulation_.asleep();
  status_.last_report = simulation_.lastReport();
  status_.last_adaptive_report = simulation_.lastAdaptiveReport();
  status_.steps = simulation_.steps();
  status_.simulated_time = simulation_.state().time;
}

void RealTimeLoop::requireRunning() const {
  if (!running_) throw std::runtime_error("the simulation does not run (any more)");
}

}  // namespace haptex::simulation
