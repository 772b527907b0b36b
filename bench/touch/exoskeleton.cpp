// How well does the exoskeleton render forces, and what does it cost? The simulated loop
// (commander, driver, line, firmware, emulated device on a person's fingers) answers in simulated
// time: step response, closed-loop bandwidth, and how long forces outlive the death of the
// commander and of the driver. The processor's time is that of a tick of the driver and of a step
// of the emulator. How stiff a virtual wall may be is found by touching ever other ones. How late
// the driver's loop wakes up and how long a command takes to the sensor is measured with real
// threads and a real pseudo-terminal. bench_exoskeleton CSV writes the curves of the first two and
// ends; scripts/plot_exoskeleton draws them.
//
// The fingers are as far apart as for taking a sample and are pushed apart. "person" has the finger
// of the emulator (400 N/m), "stiff" one of 1500 N/m: the softer the finger, the more the device
// has to move for a force, and its inertia and friction are felt.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <complex>
#include <cstdio>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "haptex/exoskeleton/emulator/hand_path.h"
#include "haptex/oracles/exact/finger_geometry.h"
#include "haptex/oracles/experiments/exoskeleton_loop.h"
#include "real_exoskeleton.h"
#include "tab_lines.h"
#include "wall_stiffness.h"

namespace {

using namespace haptex;
using namespace haptex::exoskeleton;
using Eigen::Vector3d;
using oracles::ExoskeletonLoop;
using std::chrono::milliseconds;

constexpr double kPi = 3.14159265358979323846;
constexpr double kStepFrom = 1.0, kStepTo = 2.0;   // N
constexpr double kMiddle = 1.0, kAmplitude = 0.2;  // N, of the sweep
constexpr double kSettled = 0.05;                  // of the step
const std::string kConfig = HAPTEX_CONFIG_DIRECTORY;

std::string urdf() { return oracles::shippedUrdf(kConfig); }

/// A loop that is ready, and in which direction each finger is pushed.
struct Bench {
  explicit Bench(const FingerMechanics& mechanics = {}) : loop(urdf(), 1, mechanics) {
    const HandPlace open = loadHandPath(kConfig + "/paths/pinch.yaml").at(1.5);
    const Vector3d way = open.fingertips[Finger::kIndex] - open.fingertips[Finger::kThumb];
    direction[Finger::kIndex] = way.normalized();
    direction[Finger::kThumb] = -way.normalized();
    for (const Finger finger : kFingers) {
      loop.device().setTarget(finger, open.fingertips[finger]);
    }
    loop.makeReady();
  }

  /// @param force of the time (N)
  template <typename Force>
  void command(Force force) {
    loop.setCommander([this, force](Finger finger, Time now) {
      ForceCommand command;
      command.force = force(seconds(now)) * direction[finger];
      return command;
    });
  }

  double felt(Finger finger) const {
    return loop.sample(finger).contact_force.dot(direction[finger]);
  }

  ExoskeletonLoop loop;
  PerFinger<Vector3d> direction{{Vector3d::Zero(), Vector3d::Zero()}};
};

struct Person {
  const char* name;
  FingerMechanics mechanics;
};

std::vector<Person> persons() {
  FingerMechanics stiff;
  stiff.fingertip_stiffness = 1500.0;
  stiff.fingertip_damping = 8.0;  // a damping ratio of 1.3
  return {{"person", {}}, {"stiff", stiff}};
}

std::string curve(const Person& person, Finger finger) {
  return std::string(person.name) + "_" + name(finger);
}

/// Curves for the plot: "curve,x,y" per line.
class Curves {
 public:
  explicit Curves(const char* path) {
    if (path == nullptr) return;
    file_.open(path);
    if (!file_) throw std::runtime_error(std::string(path) + ": cannot be written");
    file_ << "curve,x,y\n";
  }
  void add(const std::string& curve, double x, double y) {
    if (file_.is_open()) file_ << curve << ',' << x << ',' << y << '\n';
  }

 private:
  std::ofstream file_;
};

struct Response {
  std::vector<double> times, forces;  // s since the step, N
};

double firstAbove(const Response& response, double force) {
  for (std::size_t i = 0; i < response.times.size(); ++i) {
    if (response.forces[i] >= force) return response.times[i];
  }
  return std::numeric_limits<double>::quiet_NaN();
}

void printStep(const std::string& name, const Response& response) {
  const std::string prefix = "exoskeleton/step_" + name;
  const double height = kStepTo - kStepFrom;
  double settled = 0.0, highest = 0.0;
  for (std::size_t i = 0; i < response.times.size(); ++i) {
    highest = std::max(highest, response.forces[i]);
    if (std::abs(response.forces[i] - kStepTo) > kSettled * height) settled = response.times[i];
  }
  const double rise = firstAbove(response, kStepFrom + 0.9 * height) -
                      firstAbove(response, kStepFrom + 0.1 * height);
  bench::printLine(prefix + "_delay_to_10_percent",
                   1e3 * firstAbove(response, kStepFrom + 0.1 * height), "ms");
  bench::printLine(prefix + "_rise_10_to_90_percent", 1e3 * rise, "ms");
  bench::printLine(prefix + "_overshoot", 100.0 * std::max(0.0, highest - kStepTo) / height, "%");
  bench::printLine(prefix + "_settling_to_5_percent", 1e3 * settled, "ms");
}

void stepResponse(const Person& person, Curves& curves) {
  Bench bench(person.mechanics);
  bench.command([](double) { return kStepFrom; });
  bench.loop.run(std::chrono::seconds(3));
  const Time start = bench.loop.now();
  bench.command([](double) { return kStepTo; });
  PerFinger<Response> responses;
  bench.loop.run(milliseconds(1000), [&](const ExoskeletonLoop& loop) {
    const double time = seconds(loop.now() - start);
    for (const Finger finger : kFingers) {
      responses[finger].times.push_back(time);
      responses[finger].forces.push_back(bench.felt(finger));
      curves.add("step_" + curve(person, finger), time, bench.felt(finger));
    }
  });
  for (const Finger finger : kFingers) printStep(curve(person, finger), responses[finger]);
}

using Amplitudes = PerFinger<std::complex<double>>;

/// What a commanded sine of this frequency (Hz) comes to (N).
struct Sweep {
  Amplitudes contact{}, desired{};
};

Sweep sweep(Bench& bench, double frequency) {
  bench.command(
      [&](double time) { return kMiddle + kAmplitude * std::sin(2.0 * kPi * frequency * time); });
  const auto duration = [](double time) {
    return std::chrono::duration_cast<Time>(std::chrono::duration<double>(time));
  };
  bench.loop.run(duration(std::max(0.5, 3.0 / frequency)));
  const double cycles = std::max(3.0, std::ceil(frequency * 0.5));
  Sweep sums;
  int count = 0;
  bench.loop.run(duration(cycles / frequency), [&](const ExoskeletonLoop& loop) {
    const std::complex<double> turn = std::polar(1.0, -2.0 * kPi * frequency * seconds(loop.now()));
    for (const Finger finger : kFingers) {
      const double desired = loop.sample(finger).desired.dot(bench.direction[finger]);
      sums.contact[finger] += (bench.felt(finger) - kMiddle) * turn;
      sums.desired[finger] += (desired - kMiddle) * turn;
    }
    ++count;
  });
  for (const Finger finger : kFingers) {
    sums.contact[finger] *= 2.0 / count;
    sums.desired[finger] *= 2.0 / count;
  }
  return sums;
}

/// Where a gain over the frequency first falls below a level, by linear interpolation.
class Crossing {
 public:
  explicit Crossing(double level) : level_(level) {}
  void add(double frequency, double gain) {
    if (where_ == 0.0 && gain < level_) {
      where_ = frequency - (frequency - frequency_) * (level_ - gain) / (gain_ - gain);
    }
    frequency_ = frequency;
    gain_ = gain;
  }
  double where() const { return where_; }

 private:
  double level_, where_ = 0.0, frequency_ = 0.0, gain_ = 1.0;
};

void bandwidth(const Person& person, Curves& curves) {
  constexpr int kFrequencies = 47;
  const double half_power = std::sqrt(0.5);
  Bench bench(person.mechanics);
  bench.command([](double) { return kMiddle; });
  bench.loop.run(std::chrono::seconds(3));
  PerFinger<Crossing> control{{Crossing(half_power), Crossing(half_power)}}, chain = control;
  PerFinger<double> largest{};
  for (int i = 0; i < kFrequencies; ++i) {
    const double frequency = std::pow(200.0, i / (kFrequencies - 1.0));
    const Sweep amplitudes = sweep(bench, frequency);
    for (const Finger finger : kFingers) {
      const double contact = std::abs(amplitudes.contact[finger]);
      const double of_control = contact / std::abs(amplitudes.desired[finger]);
      const double of_chain = contact / kAmplitude;
      control[finger].add(frequency, of_control);
      chain[finger].add(frequency, of_chain);
      largest[finger] = std::max(largest[finger], of_control);
      curves.add("control_" + curve(person, finger), frequency, of_control);
      curves.add("chain_" + curve(person, finger), frequency, of_chain);
    }
  }
  for (const Finger finger : kFingers) {
    const std::string end = "_" + curve(person, finger);
    bench::printLine("exoskeleton/bandwidth_control" + end, control[finger].where(), "Hz");
    bench::printLine("exoskeleton/bandwidth_chain" + end, chain[finger].where(), "Hz");
    bench::printLine("exoskeleton/largest_gain_control" + end, largest[finger], "ratio");
  }
}

void death(bool of_the_driver) {
  double motors = 0.0, contact = 0.0;
  for (int i = 0; i < 8; ++i) {  // at any moment of the driver's period
    Bench bench;
    bench.command([](double) { return 3.0; });
    bench.loop.run(milliseconds(1500) + i * ExoskeletonLoop::kStep);
    const Time start = bench.loop.now();
    of_the_driver ? bench.loop.killDriver() : bench.loop.killCommander();
    Time last = start;
    bench.loop.run(milliseconds(20), [&](const ExoskeletonLoop& loop) {
      for (const Finger finger : kFingers) {
        if (!loop.sample(finger).motor_force.isZero(0.0)) last = loop.now();
      }
    });
    motors = std::max(motors, 1e3 * seconds(last - start));
    for (const Finger finger : kFingers) {
      contact = std::max(contact, bench.loop.sample(finger).contact_force.norm());
    }
  }
  const std::string who = of_the_driver ? "driver" : "commander";
  bench::printLine("exoskeleton/motor_force_after_" + who + "s_death_max", motors, "ms");
  bench::printLine("exoskeleton/contact_force_20ms_after_" + who + "s_death_of_3N", contact, "N");
}

/// Walls sent with their linearisation and as samples of their force, without damping and delay,
/// with more and more delay, and with more and more damping.
void wallStiffness() {
  const PerFinger<Vector3d> open = loadHandPath(kConfig + "/paths/pinch.yaml").at(1.5).fingertips;
  for (const Person& person : persons()) {
    for (const bool linearised : {true, false}) {
      for (const int delay : {0, 1, 2, 3}) {
        const oracles::VirtualWall wall{0.0, 0.0, linearised, delay};
        bench::printWallStiffness(urdf(), person.name, person.mechanics, open, wall);
      }
      for (const double damping : {1.0, 2.0, 4.0}) {
        const oracles::VirtualWall wall{0.0, damping, linearised, 0};
        bench::printWallStiffness(urdf(), person.name, person.mechanics, open, wall);
      }
    }
  }
}

void controllerTick(benchmark::State& run) {
  Bench bench;
  bench.command([](double) { return 3.0; });
  bench.loop.run(std::chrono::seconds(1));
  DeviceController& controller = bench.loop.controller();
  DeviceState state = bench.loop.device().read();
  Time now = bench.loop.now();
  ForceCommand command;
  command.force = 3.0 * bench.direction[Finger::kIndex];
  for (auto _ : run) {
    now += milliseconds(1);
    state.time += 1000;
    ++state.last_command;
    for (const Finger finger : kFingers) controller.command(finger, command, now);
    benchmark::DoNotOptimize(controller.tick(&state, now));
  }
}

void deviceStep(benchmark::State& run) {
  Bench bench;
  DeviceCommand command;
  command.mode = DriveMode::kForce;
  for (auto _ : run) bench.loop.device().step(command);
}

/// What only a clock can tell, alone and beside two busy cores.
int realTime() {
  constexpr double kLow = 0.5, kHigh = 1.5;  // N
  constexpr int kSteps = 300;
  try {
    bench::RealExoskeleton exoskeleton(urdf());
    exoskeleton.printScheduler();
    exoskeleton.measure("idle", kLow, kHigh, kSteps);
    const bench::BusyCores busy(2);
    exoskeleton.measure("busy", kLow, kHigh, kSteps);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_exoskeleton: %s\n", error.what());
    return 1;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const bool has_path = argc == 2 && argv[1][0] != '-';
  try {
    Curves curves(has_path ? argv[1] : nullptr);
    for (const Person& person : persons()) {
      stepResponse(person, curves);
      bandwidth(person, curves);
    }
    death(false);
    death(true);
    if (!has_path) wallStiffness();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_exoskeleton: %s\n", error.what());
    return 1;
  }
  if (has_path) return 0;
  benchmark::RegisterBenchmark("exoskeleton/controller_tick_both_fingers", controllerTick);
  benchmark::RegisterBenchmark("exoskeleton/emulated_step_both_fingers", deviceStep);
  if (const int status = bench::runAll(argc, argv); status != 0) return status;
  return realTime();
}
