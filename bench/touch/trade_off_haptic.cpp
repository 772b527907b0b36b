// What accuracy of the haptic layer costs: patch size, refinement, rate of the force loop and of
// the large-scale cloth against the error in force and the computing time, in three touches with
// two fabrics. Two threads share the work. bench_trade_off_haptic CSV also writes all numbers for
// scripts/plot_trade_off_haptic. Takes minutes; tells on standard error how far it is.
#include <atomic>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <functional>
#include <iostream>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "haptex/material/fabric_file.h"
#include "haptex/studies/haptic_trade_off.h"
#include "tab_lines.h"

namespace {

using namespace haptex;
using namespace haptex::studies;
using haptex::bench::printLine;

constexpr int kThreads = 2;
constexpr double kCell = 6e-4;        // m, of the reference
constexpr int kStepsPerRecord = 2;    // of the reference: 4 kHz
constexpr double kFastCloth = 0.012;  // s, 83 Hz: nearest to the shipped 80 Hz of all rates' ticks
constexpr double kSlowCloth = 0.04;   // s, 25 Hz

struct NamedPoint {
  std::string name;
  HapticPoint point;
};

NamedPoint namedPoint(int refinement, double margin, int most_elements, double rate,
                      double large_scale_step) {
  NamedPoint named;
  named.point.haptics.refinement = refinement;
  named.point.haptics.margin = margin;
  named.point.haptics.most_elements = most_elements;
  named.point.haptics.time_step = 1.0 / rate;
  named.point.large_scale_step = large_scale_step;
  char name[100];
  std::snprintf(name, sizeof name, "level_%d_%.0fmm_%d_%.0fHz_%.0fHz", refinement, 1e3 * margin,
                most_elements, rate, 1.0 / large_scale_step);
  named.name = name;
  return named;
}

/// The shipped defaults are the first.
std::vector<NamedPoint> points() {
  const haptex::contact::HapticSettings shipped;
  const auto at = [&](int refinement, double rate, double large_scale_step) {
    return namedPoint(refinement, shipped.margin, shipped.most_elements, rate, large_scale_step);
  };
  const auto sized = [](int refinement, double margin, int most_elements) {
    return namedPoint(refinement, margin, most_elements, 1000.0, kFastCloth);
  };
  std::vector<NamedPoint> all = {at(shipped.refinement, 1.0 / shipped.time_step, kFastCloth)};
  for (int refinement : {0, 1, 3, 4}) all.push_back(at(refinement, 1000.0, kFastCloth));
  for (int refinement : {0, 1, 2, 3, 4}) all.push_back(sized(refinement, 4e-3, 12));
  for (int refinement : {0, 1, 2, 3}) all.push_back(sized(refinement, 12e-3, 60));
  all.push_back(sized(2, 4e-3, 24));
  all.push_back(sized(2, 8e-3, 12));
  all.push_back(sized(2, 8e-3, 60));
  all.push_back(sized(2, 12e-3, 24));
  for (int refinement : {1, 2, 3}) {
    for (double rate : {250.0, 500.0, 2000.0}) all.push_back(at(refinement, rate, kFastCloth));
    all.push_back(at(refinement, 1000.0, kSlowCloth));
  }
  all.push_back(at(2, 250.0, kSlowCloth));
  return all;
}

/// Does job(i) for every i below `count` on kThreads threads.
void share(const char* what, int count, const std::function<void(int)>& job) {
  std::atomic<int> next{0};
  std::mutex mutex;
  int done = 0;
  std::exception_ptr failure;
  const auto work = [&] {
    for (int i = next++; i < count; i = next++) {
      try {
        job(i);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex);
        failure = std::current_exception();
        next = count;
      }
      const std::lock_guard<std::mutex> lock(mutex);
      std::cerr << '\r' << what << ' ' << ++done << " of " << count << std::flush;
    }
  };
  std::cerr << what << " 0 of " << count << std::flush;
  std::vector<std::thread> threads;
  for (int i = 0; i < kThreads; ++i) threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
  std::cerr << '\n';
  if (failure) std::rethrow_exception(failure);
}

/// A touch with one fabric.
struct Case {
  std::string fabric;
  oracles::PrescribedTouch touch;
  TouchReference reference;
  std::vector<HapticCost> costs;  // per point
  std::vector<char> dominated;    // per point, by error and time of the force loop
};

std::vector<Case> makeCases() {
  std::vector<Case> cases;
  for (const char* name : {"wool", "linear"}) {
    const auto fabric = haptex::material::loadFabric(
        std::string(HAPTEX_CONFIG_DIRECTORY "/fabrics/") + name + ".yaml");
    for (const oracles::PrescribedTouch& touch : oracles::prescribedTouches(fabric)) {
      Case& here = cases.emplace_back();
      here.fabric = name;
      here.touch = touch;
    }
  }
  share("reference", static_cast<int>(cases.size()), [&](int i) {
    cases[i].reference = computeReference(cases[i].touch, kCell, kStepsPerRecord);
  });
  return cases;
}

void measure(Case& here, const std::vector<NamedPoint>& points) {
  here.costs.resize(points.size());
  share((here.touch.name + " " + here.fabric).c_str(), static_cast<int>(points.size()),
        [&](int i) { here.costs[i] = measureTouch(here.touch, points[i].point, here.reference); });
  std::vector<ErrorAndTime> all;
  for (std::size_t p = 0; p < points.size(); ++p) {
    all.push_back({here.costs[p].force_error, here.costs[p].forceLoopTime(points[p].point)});
  }
  here.dominated = isDominated(all);
}

void printCase(const Case& here, const std::vector<NamedPoint>& points) {
  const std::string prefix = "trade_off_haptic/" + here.touch.name + "/" + here.fabric + "/";
  printLine(prefix + "reference/force", here.reference.force, "N");
  printLine(prefix + "reference/force_error", here.reference.error, "N");
  printLine(prefix + "reference/worst_error", here.reference.worst_error, "N");
  for (std::size_t p = 0; p < points.size(); ++p) {
    const HapticCost& cost = here.costs[p];
    const std::string name = prefix + points[p].name;
    const double loop = cost.forceLoopTime(points[p].point);
    printLine(name + "/force_error", cost.force_error, "N");
    printLine(name + "/worst_error", cost.worst_error, "N");
    printLine(name + "/rest_error", cost.rest_error, "N");
    printLine(name + "/tick", 1e6 * cost.tick_time, "us");
    printLine(name + "/part_of_1ms", 1e3 * cost.tick_time, "1");
    printLine(name + "/force_loop", 1e6 * loop, "us/s");
    printLine(name + "/large_scale", 1e6 * cost.large_scale_time, "us/s");
    printLine(name + "/particles", static_cast<double>(cost.particles), "1");
    printLine(name + "/rejected_steps", cost.rejected_steps, "steps");
    printLine(name + "/on_front", here.dominated[p] ? 0.0 : 1.0, "1");
  }
}

/// Error and time of every point as multiples of the shipped ones: geometric means over the cases.
void printAll(const std::vector<Case>& cases, const std::vector<NamedPoint>& points) {
  std::vector<ErrorAndTime> means;
  for (std::size_t p = 0; p < points.size(); ++p) {
    double error = 0.0, time = 0.0;
    for (const Case& here : cases) {
      error += std::log(here.costs[p].force_error / here.costs[0].force_error);
      time += std::log(here.costs[p].forceLoopTime(points[p].point) /
                       here.costs[0].forceLoopTime(points[0].point));
    }
    const double count = static_cast<double>(cases.size());
    means.push_back({std::exp(error / count), std::exp(time / count)});
  }
  const std::vector<char> dominated = isDominated(means);
  for (std::size_t p = 0; p < points.size(); ++p) {
    const std::string name = "trade_off_haptic/all/" + points[p].name;
    printLine(name + "/force_error", means[p].error, "of_shipped");
    printLine(name + "/force_loop", means[p].time, "of_shipped");
    printLine(name + "/on_front", dominated[p] ? 0.0 : 1.0, "1");
  }
}

constexpr const char* kColumns =
    "touch,fabric,reference_force,reference_error,refinement,margin,most_elements,rate,"
    "large_scale_rate,force_error,worst_error,rest_error,tick,force_loop,large_scale,particles,"
    "rejected_steps,on_front";

void writeRows(const Case& here, const std::vector<NamedPoint>& points, std::ostream& csv) {
  for (std::size_t p = 0; p < points.size(); ++p) {
    const HapticPoint& point = points[p].point;
    const HapticCost& cost = here.costs[p];
    csv << here.touch.name << ',' << here.fabric << ',' << here.reference.force << ','
        << here.reference.error << ',' << point.haptics.refinement << ',' << point.haptics.margin
        << ',' << point.haptics.most_elements << ',' << 1.0 / point.haptics.time_step << ','
        << 1.0 / point.large_scale_step << ',' << cost.force_error << ',' << cost.worst_error << ','
        << cost.rest_error << ',' << cost.tick_time << ',' << cost.forceLoopTime(point) << ','
        << cost.large_scale_time << ',' << cost.particles << ',' << cost.rejected_steps << ','
        << (here.dominated[p] ? 0 : 1) << '\n';
  }
}

/// @param csv_path null: no table
void run(const char* csv_path) {
  std::ofstream csv;
  const auto require_written = [&] {
    if (!csv.flush()) throw std::runtime_error(std::string(csv_path) + ": cannot be written");
  };
  if (csv_path) {
    csv.open(csv_path);
    csv << kColumns << '\n';
    require_written();
  }
  const std::vector<NamedPoint> all_points = points();
  std::vector<Case> cases = makeCases();
  for (Case& here : cases) {
    measure(here, all_points);
    printCase(here, all_points);
    if (!csv_path) continue;
    writeRows(here, all_points, csv);
    require_written();
  }
  printAll(cases, all_points);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    run(argc == 2 ? argv[1] : nullptr);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "bench_trade_off_haptic: " << error.what() << '\n';
    return 1;
  }
}
