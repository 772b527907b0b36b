#include "haptex/oracles/experiments/direct_stroke.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <kissfft/kissfft.hh>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace haptex::oracles {
namespace {

using tactile::Channel;
using tactile::HeightField;
using tactile::PerChannel;
using Complex = std::complex<double>;

/// Weights of `count` samples of one period, `place` samples after the first.
Eigen::VectorXd dirichletWeights(double place, int count) {
  Eigen::VectorXd weights(count);
  for (int i = 0; i < count; ++i) {
    const double offset = std::remainder(place - i, count);
    const double angle = M_PI * offset / count;
    if (offset == 0.0) {
      weights[i] = 1.0;
    } else if (count % 2 == 1) {
      weights[i] = std::sin(M_PI * offset) / (count * std::sin(angle));
    } else {
      weights[i] = std::sin(M_PI * offset) / (count * std::tan(angle));
    }
  }
  return weights;
}

int nextPowerOfTwo(int number) {
  int power = 1;
  while (power < number) power *= 2;
  return power;
}

/// Integers (a, b) with a q - b p = +-1 for p and q without common divisor.
Eigen::Vector2i across(const Eigen::Vector2i& crossings) {
  const int most_a = std::max(1, std::abs(crossings.x()));
  const int most_b = std::max(1, std::abs(crossings.y()));
  for (int b = 0; b <= most_b; ++b) {
    for (int a = -most_a; a <= most_a; ++a) {
      if (std::abs(a * crossings.y() - b * crossings.x()) == 1) return {a, b};
    }
  }
  std::ostringstream message;
  message << "a stroke with " << crossings.x() << " and " << crossings.y()
          << " crossings: allowed are two numbers without common divisor";
  throw std::invalid_argument(message.str());
}

/// Adds the powers of the lines of a profile; line 0 is left out.
void addPowers(const std::vector<Complex>& profile, double scale, std::vector<double>& powers) {
  std::vector<Complex> lines(profile.size());
  kissfft<double>(profile.size(), false).transform(profile.data(), lines.data());
  powers.resize(profile.size() / 2);
  for (std::size_t i = 1; i < powers.size(); ++i) powers[i] += scale * 2.0 * std::norm(lines[i]);
}

PerChannel<double> channelsOf(const std::vector<double>& powers, double line_spacing) {
  PerChannel<double> amplitudes{};
  for (const Channel channel : {tactile::k40, tactile::k320}) {
    double sum = 0.0;
    for (std::size_t i = 1; i < powers.size(); ++i) {
      const double gain = tactile::gain(channel, line_spacing * static_cast<double>(i));
      sum += gain * gain * powers[i];
    }
    amplitudes[channel] = std::sqrt(2.0 * sum);
  }
  return amplitudes;
}

}  // namespace

InterpolatedRelief::InterpolatedRelief(const HeightField& field) : field_(field) {
  tactile::requireSound(field);
}

double InterpolatedRelief::operator()(const Eigen::Vector2d& place) const {
  using Heights = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Map<const Heights> heights(field_.heights.data(), field_.rows, field_.columns);
  const Eigen::VectorXd of_columns =
      dirichletWeights(place.x() / field_.weft_spacing, field_.columns);
  const Eigen::VectorXd of_rows = dirichletWeights(place.y() / field_.warp_spacing, field_.rows);
  return of_rows.dot(heights * of_columns);
}

Eigen::Vector2d InterpolatedRelief::period() const {
  return {field_.columns * field_.weft_spacing, field_.rows * field_.warp_spacing};
}

HeightField InterpolatedRelief::oddlySampled() const {
  HeightField odd = field_;
  odd.columns |= 1;
  odd.rows |= 1;
  odd.weft_spacing = period().x() / odd.columns;
  odd.warp_spacing = period().y() / odd.rows;
  odd.heights.clear();
  for (int row = 0; row < odd.rows; ++row) {
    for (int column = 0; column < odd.columns; ++column) {
      odd.heights.push_back((*this)({column * odd.weft_spacing, row * odd.warp_spacing}));
    }
  }
  return odd;
}

PerChannel<double> alongClosedStrokes(const HeightField& field, const Eigen::Vector2i& crossings,
                                      double speed) {
  const InterpolatedRelief relief(field);
  const Eigen::Vector2d step_aside = across(crossings).cast<double>().cwiseProduct(relief.period());
  const Eigen::Vector2d way = crossings.cast<double>().cwiseProduct(relief.period());
  // Wave (m, n) is line m p + n q of a stroke with p and q crossings: twice the highest, and more.
  const int samples = nextPowerOfTwo(std::abs(crossings.x()) * field.columns +
                                     std::abs(crossings.y()) * field.rows + 1);
  // Two waves of the same line differ by a multiple t of (q, -p), and in phase by t turns over all
  // strokes: with more strokes than the largest t the mean of their product is zero.
  const int strokes = std::max(field.columns, field.rows);
  std::vector<double> powers;
  std::vector<Complex> profile(samples);
  for (int stroke = 0; stroke < strokes; ++stroke) {
    const Eigen::Vector2d start = step_aside * stroke / strokes;
    for (int i = 0; i < samples; ++i) profile[i] = relief(start + way * i / samples);
    addPowers(profile, 1.0 / (static_cast<double>(samples) * samples * strokes), powers);
  }
  return channelsOf(powers, speed / way.norm());
}

PerChannel<double> alongLongStrokes(const Relief& relief, const LongStrokes& strokes) {
  const int samples = static_cast<int>(strokes.length / strokes.spacing);
  const Eigen::Vector2d step = strokes.spacing * strokes.velocity.normalized();
  std::vector<double> powers;
  std::vector<Complex> profile(samples);
  for (int stroke = 0; stroke < strokes.strokes; ++stroke) {
    // Powers of the number with g^3 = g + 1: no two starts are near each other, however many.
    constexpr double kG = 1.32471795724474602596;
    const Eigen::Vector2d share(std::fmod(stroke / kG, 1.0), std::fmod(stroke / (kG * kG), 1.0));
    const Eigen::Vector2d start = strokes.starts.cwiseProduct(share);
    double squares = 0.0;
    for (int i = 0; i < samples; ++i) {
      const double sine = std::sin(M_PI * (i + 0.5) / samples);
      const double window = sine * sine;
      squares += window * window;
      profile[i] = window * relief(start + step * i);
    }
    addPowers(profile, 1.0 / (squares * samples * strokes.strokes), powers);
  }
  return channelsOf(powers, strokes.velocity.norm() / (samples * strokes.spacing));
}

}  // namespace haptex::oracles
