// What a quality was measured to miss for the studied fabric that is nearest to another one.
#pragma once

#include <string>
#include <vector>

#include "haptex/material/fabric.h"
#include "haptex/scene/quality.h"

namespace haptex::simulation {

/// A fabric of the trade-off study.
struct StudiedFabric {
  std::string name;              ///< of its file in config/fabrics
  double tensile_modulus = 0.0;  ///< N/m, tensileModulus()
};

/// Mean of weft and warp at zero strain, N/m.
double tensileModulus(const material::Fabric& fabric);

/// The names of the fabrics of all measurements, each once, in the order of their appearance.
std::vector<std::string> studiedFabricNames(const std::vector<scene::Quality>& qualities);

/// The one of the fabric's name, or else the one whose tensile modulus has the smallest ratio to
/// the fabric's, upwards or downwards.
/// @param studied at least one
const StudiedFabric& nearestStudied(const material::Fabric& fabric,
                                    const std::vector<StudiedFabric>& studied);

/// Of qualities for several fabrics (Quality::fabric) those for the fabric's nearestStudied(), and
/// those for any, in their order.
/// @param studied fabrics that the qualities are for
std::vector<scene::Quality> qualitiesFor(const material::Fabric& fabric,
                                         const std::vector<scene::Quality>& qualities,
                                         const std::vector<StudiedFabric>& studied);

/// The measurements of a quality for one fabric.
std::vector<scene::MeasuredQuality> measurementsOf(const scene::Quality& quality,
                                                   const std::string& fabric);

}  // namespace haptex::simulation
