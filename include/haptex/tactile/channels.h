// The two channels of the tactile array and the band-pass filters that lead to them.
#pragma once

#include <array>

namespace haptex::tactile {

/// Channels of 40 Hz, felt by the non-Pacinian receptors (NP I), and of 320 Hz, felt by the
/// Pacinian ones (P).
constexpr int kChannels = 2;
enum Channel { k40, k320 };
template <typename T>
using PerChannel = std::array<T, kChannels>;
constexpr PerChannel<double> kChannelFrequencies{40.0, 320.0};  ///< Hz

/// Gain of amplitudes of a wave felt at `frequency` (Hz, >= 0) in a channel: how large a vibration
/// at the channel's frequency its receptors feel as strongly. With r the ratio of the two
/// frequencies,
///   G40 = 1/sqrt(1 + (r - 1/r)^2),   G320 = 1/(1 + (r - 1/r)^2):
/// band-passes of second order and quality factor 1, one for NP I and two in a row for P. Their
/// skirts of 6 and 12 dB per octave are near the slopes of the detection thresholds of displacement
/// on both sides of these receptors' best frequencies (Bolanowski, Gescheider, Verrillo and
/// Checkosky 1988, J. Acoust. Soc. Am. 84:1680; Gescheider, Bolanowski and Hardick 2001,
/// Somatosens. Mot. Res. 18:191). 1 at the channel's frequency, 0 at 0 Hz.
double gain(Channel channel, double frequency);

}  // namespace haptex::tactile
