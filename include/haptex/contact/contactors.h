// Which part of a contact's normal force each contactor of the tactile array carries.
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "haptex/contact/fingertip.h"
#include "haptex/contact/haptic_layer.h"

namespace haptex::contact {

constexpr int kContactorRows = 4;     ///< along y of the array
constexpr int kContactorColumns = 6;  ///< along x of the array
constexpr int kContactors = kContactorRows * kContactorColumns;
constexpr double kContactorSpacing = 2e-3;  ///< m

/// Normal force (N) under every contactor, index 6 row + column. Every contact point is projected
/// onto the array's plane and shared by bilinear weights among the four contactors around it, so
/// that the sum is the normal force of the contact points within the array, and no contactor's
/// force jumps while a point moves. Beyond the outermost contactors the weights fall to zero within
/// one spacing.
/// @param array frame of the array in the fingertip's frame: z out of the pad, x distal, origin in
///   the middle
std::array<double, kContactors> contactorForces(const FingertipContact& contact,
                                                const Fingertip& fingertip,
                                                const Eigen::Isometry3d& array);

}  // namespace haptex::contact
