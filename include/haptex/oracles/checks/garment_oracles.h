// Parts of validateGarment(), by what they look at.
#pragma once

#include <string>

#include "haptex/oracles/checks/validation.h"

namespace haptex::oracles {

/// Panels that are sewn along straight and curved lines and darts, by ties and merged: uniform
/// stress across the seam, gaps, mass and momentum.
void validateSeams(const Sink& sink);

/// Discs with a sector cut out and sewn.
void validateCones(const Sink& sink);

/// Strips with a seam against those in one piece: length under their weight, period, and energy of
/// bending.
void validateSewnStrips(const Sink& sink);

/// Figures with measurements: girths, by another formula than that by which they are fitted, and
/// lengths; whether they are closed.
void validateBodies(const std::string& config_directory, const Sink& sink);

/// Panels on a cone; the shipped garments with carriers on the shipped bodies.
void validatePreposition(const std::string& config_directory, const Sink& sink);

/// A sheet between a bar that stands and one that turns about a hinge: the reaction on the bars
/// against virtual work, and the sheet after 100 turns to and fro.
void validateLinkage(const std::string& config_directory, const Sink& sink);

/// Buttons, hooks and elastic bands between two pieces of cloth: the force at which one opens, of
/// elastic bands the tension by length, and energy and momentum of what is torn apart. The tension
/// of a drawstring that cloth has slid along.
void validateFasteners(const std::string& config_directory, const Sink& sink);

/// An inflated ball, whose radius and tension are those of Laplace's law; a stuffed cushion at
/// rest, whose pressure and tension do as much virtual work when it grows.
void validateStuffing(const Sink& sink);

}  // namespace haptex::oracles
