#include "haptex/garment/body/measured_body.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "haptex/base/require.h"
#include "haptex/garment/body/makehuman.h"
#include "haptex/garment/body/measurements.h"

namespace haptex::garment {
namespace {

using base::refuse;
using Eigen::Vector3d;

constexpr double kConverged = 1e-6;  // m
constexpr int kMostTurns = 60;

const std::map<std::string, std::string>& targetNames() {
  static const std::map<std::string, std::string> names = {
      {"chest", "bust-circ"},
      {"waist", "waist-circ"},
      {"hips", "hips-circ"},
      {"neck", "neck-circ"},
      {"upper_arm", "upperarm-circ"},
      {"wrist", "wrist-circ"},
      {"thigh", "thigh-circ"},
      {"knee", "knee-circ"},
      {"calf", "calf-circ"},
      {"ankle", "ankle-circ"},
      {"upper_arm_length", "upperarm-length"},
      {"forearm_length", "lowerarm-length"},
      {"thigh_length", "upperleg-height"},
      {"shank_length", "lowerleg-height"},
  };
  return names;
}

/// To whole millimetres inside of a range, for messages.
double roundedUp(double length) { return 1e-3 * std::ceil(1e3 * length); }
double roundedDown(double length) { return 1e-3 * std::floor(1e3 * length); }

void add(const Target& target, double weight, std::vector<Vector3d>& positions) {
  for (const Target::Step& step : target.steps) positions[step.vertex] += weight * step.by;
}

class Tailor {
 public:
  Tailor(const std::string& directory, FigureShape shape, const Measures& asked)
      : figure_(loadFigure(directory)) {
    const std::size_t vertices = figure_.mesh.positions.size();
    const std::string sex = shape == FigureShape::kFemale ? "female" : "male";
    add(loadTarget(directory + "/macro/caucasian-" + sex + "-young.target", vertices), 1.0,
        figure_.mesh.positions);
    positions_ = figure_.mesh.positions;
    body_ = bodyOf(figure_, positions_, 1.0);
    for (const auto& [name, value] : asked) {
      const Measurement& measurement = measurementNamed(name);
      if (!(std::isfinite(value) && value > 0.0)) {
        refuse(name, " is ", value, " m: allowed are finite lengths > 0");
      }
      if (measurement.kind == Measurement::Kind::kHeight) {
        height_ = value;
        continue;
      }
      const std::string file = directory + "/measure/measure-" + targetNames().at(name);
      changes_.push_back({name, value, Tape(measurement, body_),
                          loadTarget(file + "-decr.target", vertices),
                          loadTarget(file + "-incr.target", vertices)});
    }
  }

  Body fit() {
    for (int turn = 0; turn < kMostTurns; ++turn) {
      double worst = setHeight();
      for (Change& change : changes_) worst = std::max(worst, std::abs(errorOf(change)));
      if (worst <= kConverged) break;
      for (Change& change : changes_) solve(change);
    }
    for (Change& change : changes_) requireReached(change);
    return std::move(body_);
  }

 private:
  struct Change {
    std::string name;
    double asked;  // m
    Tape tape;
    Target less, more;
    double weight = 0.0;  // from -1, all of `less`, to 1, all of `more`
  };

  /// Scales the body; how far its height was off, m.
  double setHeight() {
    if (!height_) return 0.0;
    const double height = measure(body_, "height"), scale = scale_ * *height_ / height;
    if (!(scale >= kLeastScale && scale <= kLargestScale)) {
      refuse("height is ", *height_, " m: allowed are ", roundedUp(kLeastScale * height / scale_),
             " to ", roundedDown(kLargestScale * height / scale_),
             " m beside the other measurements");
    }
    scale_ = scale;
    refresh();
    return std::abs(height - *height_);
  }

  void refresh() { moveTo(figure_, positions_, scale_, body_); }
  double errorOf(const Change& change) const { return change.tape.measure(body_) - change.asked; }

  double errorAt(Change& change, double weight) {
    add(change.weight < 0.0 ? change.less : change.more, -std::abs(change.weight), positions_);
    add(weight < 0.0 ? change.less : change.more, std::abs(weight), positions_);
    change.weight = weight;
    refresh();
    return errorOf(change);
  }

  // By false position in the Illinois form; what is out of reach is left at the end nearer to it.
  void solve(Change& change) {
    double low = -1.0, high = 1.0;
    double below = errorAt(change, low);
    if (below >= 0.0) return;
    double above = errorAt(change, high);
    if (above <= 0.0) return;
    int side = 0;
    for (int i = 0; i < 100; ++i) {
      const double middle = (low * above - high * below) / (above - below);
      const double error = errorAt(change, middle);
      if (std::abs(error) <= 0.1 * kConverged) return;
      if (error < 0.0) {
        low = middle;
        below = error;
        if (side == -1) above *= 0.5;
        side = -1;
      } else {
        high = middle;
        above = error;
        if (side == 1) below *= 0.5;
        side = 1;
      }
    }
  }

  void requireReached(Change& change) {
    const double error = errorOf(change);
    if (std::abs(error) <= kMeasureTolerance) return;
    const double least = change.asked + errorAt(change, -1.0);
    const double largest = change.asked + errorAt(change, 1.0);
    refuse(change.name, " is ", change.asked, " m: allowed are ", roundedUp(least), " to ",
           roundedDown(largest), " m beside the other measurements");
  }

  Figure figure_;
  std::vector<Vector3d> positions_;
  Body body_;
  std::vector<Change> changes_;
  std::optional<double> height_;
  double scale_ = 1.0;
};

}  // namespace

Body measuredBody(const std::string& directory, FigureShape shape, const Measures& asked) {
  return Tailor(directory, shape, asked).fit();
}

}  // namespace haptex::garment
