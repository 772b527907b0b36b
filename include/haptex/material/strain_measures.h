// Exact conversion between what a tensile tester records and what the element computes with.
#pragma once

#include <vector>

#include "haptex/material/strain_stress_curve.h"

namespace haptex::material {

/// Green-Lagrange strain (l^2 - 1)/2 of the stretch l = 1 + engineering_strain.
double greenStrain(double engineering_strain);

/// Engineering strain of a Green-Lagrange strain >= -1/2; inverse of greenStrain() on stretches
/// l >= 0, accurate to rounding near zero.
double engineeringStrain(double green_strain);

/// Second Piola-Kirchhoff stress N/l (N/m) of the force per rest width N (N/m) that a tester
/// records at engineering strain l - 1 > -1 while it holds the transverse stretch.
double secondPiolaStress(double force_per_width, double engineering_strain);

/// Force per rest width l s (N/m) of the second Piola-Kirchhoff stress s (N/m) at Green-Lagrange
/// strain (l^2 - 1)/2; inverse of secondPiolaStress().
double forcePerWidth(double second_piola_stress, double green_strain);

/// Tester samples (engineering strain, force per rest width in N/m) as curve points.
/// @throws std::invalid_argument if a strain is not finite or <= -1, or a force is not finite
std::vector<CurvePoint> curvePointsFromTester(const std::vector<CurvePoint>& tester_samples);

}  // namespace haptex::material
