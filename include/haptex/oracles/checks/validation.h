// What scripts/validate prints: the oracles of each room.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "haptex/base/quantity.h"
#include "haptex/material/strain_stress_curve.h"

namespace haptex::oracles {

using Sink = std::function<void(const base::Quantity&)>;

constexpr double kRounding = 1e-12;  ///< relative error of a few operations

/// A room and its oracles, which read fabrics from a configuration directory (config/ of the
/// package, beside which urdf/ lies) and hand each quantity to the sink as soon as it is known.
struct Validation {
  std::string room;
  std::function<void(const std::string& config_directory, const Sink& sink)> run;
};

/// All rooms with oracles, in the order in which they build on each other.
const std::vector<Validation>& validations();

/// Conversions of strain and stress, and the shipped fabrics' curves against their samples.
void validateMaterial(const std::string& config_directory, const Sink& sink);

/// Virtual tensile and shear tests, hanging strip, patch test, Jacobian, integrators.
void validateCloth(const std::string& config_directory, const Sink& sink);

/// Answers of proximity queries on deformed sheets against brute force and FCL: how many differ.
void validateProximity(const std::string& config_directory, const Sink& sink);

/// Contact of the cloth with itself: stacks of layers, friction, momentum, and intersections in
/// every state of cloth that folds, heaps, twists and is pulled tight.
void validateSelfCollision(const std::string& config_directory, const Sink& sink);

/// Obstacles with mass: free fall, inclines, impacts, momentum and energy with the cloth, weights,
/// and the shipped scene net.
/// @throws what loadScene() and loadFabric() throw
void validateBody(const std::string& config_directory, const Sink& sink);

/// Two fingertips on the wool sample, both layers in one loop without clocks: equilibrium, contact
/// cases, friction, refinement, and what disturbs the feel. Takes minutes.
void validateContact(const std::string& config_directory, const Sink& sink);

/// Fabric on a plate under one finger, both layers in one loop without clocks: force of a press and
/// drag of fabric that slips. Fast fingers, which must not get through, are a random check.
void validateTable(const std::string& config_directory, const Sink& sink);

/// Cloth of two fabrics: a strip in series, a press on either side of the border, and a finger that
/// rubs across it.
void validateRegions(const std::string& config_directory, const Sink& sink);

/// Panels that are sewn together: uniform stress across seams, gaps, mass, momentum, cones of discs
/// with a sector cut out, and strips with a seam. Bodies with measurements, and panels around them.
/// What opens at its release force.
/// @throws what loadPattern() and loadBody() throw
void validateGarment(const std::string& config_directory, const Sink& sink);

/// Relative, of the force of a press on a woven fabric: 1 %, and 10 % by the coarse patches under
/// sanitizers.
double pressTolerance();
/// Relative, of frictionOfDrag(): half a percent, and by what one layer tells the other too late,
/// as the finger goes on meanwhile, 1.5 % per 10 mm/s.
/// @param speed m/s
double dragTolerance(double speed);

/// Kinematics of the fingers of urdf/hand_exoskeleton.urdf: against differences, closed forms and
/// what its comment says, and whether the fingertips meet.
/// @throws std::invalid_argument naming the file if it cannot be read, and as FingerKinematics
void validateExoskeleton(const std::string& config_directory, const Sink& sink);

/// Gratings, symmetries, k-space against the spectra of heights along strokes, and the fabrics with
/// a surface: whether they feel as rough as they are, and whether weaves differ.
/// @throws what loadFabric() and buildSurface() throw
void validateTactile(const std::string& config_directory, const Sink& sink);

/// Drive electronics of the contactors behind a simulated serial line: the waveforms against exact
/// sums of sines, their jumps, calibration, silence after the death of source, driver or line, and
/// damaged frames.
/// @throws what tactile::loadCalibration() throws
void validateTactileDriver(const std::string& config_directory, const Sink& sink);

/// Bidirectional texture functions of small reliefs: the sky that they see, white furnace,
/// reciprocity, directions between the sampled ones, and the mean over a repeat against paths of
/// light.
void validateAppearance(const std::string& config_directory, const Sink& sink);

/// The [strain, stress] samples of a fabric file as they stand in it, as Green-Lagrange strain and
/// second Piola-Kirchhoff stress. @param curve for example "warp.elastic"
/// @throws what loadFabric() throws for a bad file, std::invalid_argument if the curve has no
/// points
std::vector<material::CurvePoint> fabricSamples(const std::string& path, const std::string& curve);

}  // namespace haptex::oracles
