// The two sines that every contactor vibrates by.
#pragma once

#include "haptex/tactile/channels.h"

namespace haptex::tactile {

constexpr double kHighestSampleRate = 1e6;  ///< Hz

/// @returns sample_rate, Hz
/// @throws std::invalid_argument naming the rate unless it is more than twice the highest channel's
///   frequency and at most kHighestSampleRate
double requireSampleRate(double sample_rate);

/// sin(2 pi f_c n/sample_rate) of both channels at sample n >= 0. Whole turns are taken off where
/// all is exact, so the phase is as good after years as at first. @param sample_rate Hz
PerChannel<double> sinesAt(long long sample, double sample_rate);

}  // namespace haptex::tactile
