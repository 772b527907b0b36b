// Conversions between the tactile room and the messages of msg/. Messages come from outside:
// nothing in them is believed.
#pragma once

#include <haptex/Contact.h>
#include <haptex/Tactile.h>
#include <ros/time.h>

#include <optional>

#include "haptex/base/finger.h"
#include "haptex/tactile/contactor_array.h"

namespace haptex::nodes {

/// The largest numbers of a contact that are believed.
constexpr double kFastestStroke = 100.0;   ///< m/s
constexpr double kMaxPress = 1000.0;       ///< N
constexpr double kFarthestPlace = 1000.0;  ///< m, on a fabric
constexpr double kMaxStretch = 1000.0;     ///< of weft or warp per length of the array

/// How a fingertip lies on the fabric; nothing if it does not touch. Where the message does not say
/// how the array lies (array_x and array_y all zero), its axes are weft and warp, and its origin is
/// fabric_position.
/// @throws std::invalid_argument naming field, value and what is allowed: another frame than
///   fixedFrame(), a number that is not finite or beyond the limits above, a negative normal force
std::optional<tactile::TouchedFabric> touchedFabric(const haptex::Contact& message);

/// What does not change: the frame and the places of the contactors. All else is zero.
haptex::Tactile tactileMessage(base::Finger finger);

/// Fills in a step, without allocation.
/// @param touched null without contact @param step_time s
void fillTactile(const tactile::TouchedFabric* touched, const tactile::ArrayAmplitudes& amplitudes,
                 double step_time, const ros::Time& stamp, haptex::Tactile& message);

}  // namespace haptex::nodes
