// Virtual drape test: a disc of fabric over a smaller one, and the shadow that it throws.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "haptex/material/fabric.h"
#include "haptex/mesh/mesh.h"

namespace haptex::studies {

/// Drapemeter after Cusick: the fabric is clamped between two horizontal discs, and what is beyond
/// them hangs down freely.
struct DrapeTest {
  double fabric_radius = 0.127;    ///< m
  double support_radius = 0.0635;  ///< m
  int rings = 24;                  ///< of the mesh (mesh::makeDisc()), even
  double time_step = 0.01;         ///< s
  double most_time = 6.0;          ///< s, simulated
  double rest_speed = 5e-4;        ///< m/s: done when the fastest particle is slower than that
};

struct DrapeOutcome {
  double coefficient;     ///< of the ring's flat area, 0 to 1: shadow less support
  int nodes;              ///< folds: maxima of the shadow's edge
  double time;            ///< s, simulated until the fabric was at rest
  double fastest;         ///< m/s, at the end
  int inside_support;     ///< particles below the support and nearer to its axis than its edge
  mesh::ClothMesh shape;  ///< as draped
};

/// Lets the fabric fall from flat, every free particle displaced at random by 0.1 mm (standard
/// deviation) up or down. Gravity, bending with the fabric's hysteresis (2HB) if it has one, and
/// its viscosity; no air, no contact of folds with each other.
/// @throws std::invalid_argument if the fabric has no bending rigidity, or what makeDisc() says
DrapeOutcome drape(const material::Fabric& fabric, const DrapeTest& test, unsigned seed);

/// Radius of the shadow (m) that a mesh throws along z, at angles 2 pi i / count about the origin.
std::vector<double> shadowRadii(const mesh::ClothMesh& mesh, int count);

/// Drape coefficient from the shadow's radii: the area between support and shadow over that between
/// support and flat fabric.
double drapeCoefficient(const std::vector<double>& radii, const DrapeTest& test);

/// Maxima of a closed curve of radii that stand out from the minima on both sides by more than
/// `prominence` (m).
int countNodes(const std::vector<double>& radii, double prominence);

}  // namespace haptex::studies
