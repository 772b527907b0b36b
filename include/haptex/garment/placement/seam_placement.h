// Where panels lie on their carriers so that what is sewn together is close together.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "haptex/garment/pattern/pattern.h"
#include "haptex/garment/placement/carrier_surface.h"
#include "haptex/garment/placement/seam_points.h"

namespace haptex::garment {

/// A panel as it is to be placed.
struct PanelToPlace {
  PanelView view;
  std::optional<Eigen::Isometry3d> pose = {};  ///< lies there, in the world, and stays
  CarrierSurface surface = {};                 ///< if it has no pose
  /// m, of the surface in the middle of its panels. Between panels of one carrier distances are
  /// those on a cylinder of this radius: on a cone panels with gaps between them would slide to
  /// where it is narrow.
  double radius = 0.0;
  double least_height = 0.0;  ///< m, where its middle is looked for at first
  double largest_height = 0.0;
  std::optional<double> angle = {};   ///< given
  std::optional<double> height = {};  ///< given
  PlaceOnSurface place = {};          ///< found
  bool placed = false;                ///< `place` was found before, with other surfaces or gaps
};

/// Finds places: the sum over all seams of the squared distances between the points that are to
/// meet, each in proportion to the length of its seam, is least, for which every panel first gets
/// the best place of a grid, beginning with what is sewn most to those that have theirs, and then
/// all of them are moved together (Levenberg 1944, Marquardt 1963). Points are as far apart as
/// their seam's gap if edges lie beside each other.
/// @param panels as many as the pattern has; those that were placed before start from there
/// @param gaps m, per seam, >= 0
/// @throws std::invalid_argument naming a panel if neither it nor any that it is sewn to, through
///   however many, has both an angle and a height given or a pose
void placeBySeams(const Pattern& pattern, const std::vector<double>& gaps,
                  std::vector<PanelToPlace>& panels);

}  // namespace haptex::garment
