// What a contact is like at the contactors of the tactile array: force under each, and where they
// are on the fabric.
#pragma once

#include <Eigen/Geometry>

#include "haptex/contact/fingertip.h"
#include "haptex/contact/haptic_layer.h"
#include "haptex/tactile/contactor_array.h"

namespace haptex::contact {

/// Normal force (N) under every contactor. Every contact point is projected
/// onto the array's plane and shared by bilinear weights among the four contactors around it, so
/// that the sum is the normal force of the contact points within the array, and no contactor's
/// force jumps while a point moves. Beyond the outermost contactors the weights fall to zero within
/// one spacing.
/// @param array frame of the array in the fingertip's frame: z out of the pad, x distal, origin in
///   the middle
tactile::PerContactor<double> contactorForces(const FingertipContact& contact,
                                              const Fingertip& fingertip,
                                              const Eigen::Isometry3d& array);

/// Where the array lies on the fabric: its plane projected onto the cloth along the cloth's normal,
/// as far from the contact's centre as it is in space. Zero without contact.
/// @param array as above
tactile::ArrayPlacement arrayOnFabric(const FingertipContact& contact, const Fingertip& fingertip,
                                      const Eigen::Isometry3d& array);

}  // namespace haptex::contact
