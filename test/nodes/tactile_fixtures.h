// A surface of one wave and contacts with it.
#pragma once

#include <haptex/Contact.h>

#include <cmath>

#include "haptex/nodes/tactile_renderer/tactile_messages.h"
#include "haptex/tactile/contactor_array.h"

namespace haptex::nodes {

constexpr double kWaveHeight = 1e-5;  // m, amplitude
constexpr double kWaveLength = 1e-3;  // m, along weft
constexpr double kWaveSpeed = 0.04;   // m/s along weft, at which it is felt at 40 Hz
constexpr double kPressOfOne = 0.03;  // N, under every contactor
constexpr double kShareOfOne = 0.75;  // of the vibration that a contactor so takes on

/// A grating along weft.
inline tactile::Surface grating() {
  constexpr double kPi = 3.14159265358979323846;
  tactile::HeightField field{16, 2, kWaveLength / 16, kWaveLength / 16, {}};
  for (int i = 0; i < field.columns * field.rows; ++i) {
    field.heights.push_back(kWaveHeight *
                            std::sin(2.0 * kPi * (i % field.columns) / field.columns));
  }
  tactile::Surface surface;
  surface.fabric = "grating";
  surface.small_scale.waves = tactile::kSpaceOfPeriodic(field);
  return surface;
}

/// All contactors touch; the array lies on the fabric with x along warp.
inline haptex::Contact slidingContact(double speed = kWaveSpeed) {
  haptex::Contact contact;
  contact.header.frame_id = "world";
  contact.touching = true;
  contact.normal_force = tactile::kContactors * kPressOfOne;
  contact.fabric_position = {0.11, 0.22};
  contact.fabric_velocity = {speed, 0.0};
  contact.array_origin = {0.1, 0.2};
  contact.array_x = {0.0, 1.0};
  contact.array_y = {-1.0, 0.0};
  contact.contactor_forces.fill(kPressOfOne);
  return contact;
}

inline haptex::Contact noContact() {
  haptex::Contact contact;
  contact.header.frame_id = "world";
  return contact;
}

}  // namespace haptex::nodes
