// The parts of validateContact(), by what they look at.
#pragma once

#include <Eigen/Core>

#include "haptex/material/fabric.h"
#include "haptex/oracles/checks/validation.h"

namespace haptex::oracles {

inline const Eigen::Vector3d kStill = Eigen::Vector3d::Zero();  ///< for move(): no way

/// The sample hangs from the fingertips, and is stretched between them and the bar.
void validateContactEquilibrium(const material::Fabric& fabric, const Sink& sink);
/// The contact cases, and force against depth under refinement.
void validateContactTouch(const material::Fabric& fabric, const Sink& sink);
/// Coulomb friction: slip, stick, drift.
void validateContactFriction(const material::Fabric& fabric, const Sink& sink);
/// Ripple, steps when the patch moves on, energy at the fingertip, the whole cloth at 1 kHz.
void validateContactFeel(const material::Fabric& fabric, const Sink& sink);
/// Force of a pinch that carries the hanging sample, against the whole cloth in one layer.
void validateMovedPinch(const material::Fabric& fabric, const Sink& sink);

/// The large-scale cloth among rigid obstacles.
void validateContactObstacles(const Sink& sink);

}  // namespace haptex::oracles
