// Contacts, the local patch and the rates of the loops as rviz markers.
#pragma once

#include <ros/time.h>
#include <visualization_msgs/MarkerArray.h>

#include <string>

#include "haptex/base/finger.h"
#include "haptex/simulation/force_loop.h"

namespace haptex::nodes {

/// Hz, NaN where it is not known yet.
struct LoopRates {
  double force = 0.0;
  double cloth = 0.0;
  double proximity = 0.0;
  double exoskeleton = 0.0;
};

/// Length (m) of the arrow of a force (N): logarithmic, so that 0.01 N (9 mm) and 5 N (81 mm) are
/// seen on the same picture. Below kMinShownForce there is none.
double arrowLength(double force);
constexpr double kMinShownForce = 0.001;  // N

/// Where on the colour map the contact force on a particle lies: logarithmic over three decades up
/// to 0.1 N.
double contactForceFraction(double force);

/// One line per loop, and per finger the force that is rendered and why it is not the whole of it.
/// @param why of each finger; empty if nothing stands in the way
std::string rateText(const LoopRates& rates, const base::PerFinger<double>& forces,
                     const base::PerFinger<std::string>& why);

/// Markers in the frame fixedFrame(), in namespaces that rviz can switch off singly:
/// "contact_points": where the fingertips touch, coloured by contact force.
/// "contact_force": per finger an arrow of the rendered force, from the skin of the fingertip.
/// "patch": the small-scale cloth, coloured by contact force, a little off the cloth on both sides.
/// "rates": text with the rates, forces and why there are none, above the origin, where samples
/// hang.
class ContactMarkers {
 public:
  ContactMarkers();

  /// What there is nothing of is deleted. Valid until the next call.
  /// @param why as rateText()
  const visualization_msgs::MarkerArray& update(const simulation::ContactPicture& picture,
                                                const LoopRates& rates, const ros::Time& stamp,
                                                const base::PerFinger<std::string>& why = {});

 private:
  void updatePoints(const simulation::ContactPicture& picture);
  void updateForce(base::Finger finger, const simulation::ContactPicture& picture);
  void updatePatch(const simulation::ContactPicture& picture);

  visualization_msgs::MarkerArray markers_;
};

}  // namespace haptex::nodes
