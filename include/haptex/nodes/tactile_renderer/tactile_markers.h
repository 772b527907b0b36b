// The vibrations of the tactile arrays as rviz markers.
#pragma once

#include <haptex/Tactile.h>
#include <ros/time.h>
#include <visualization_msgs/MarkerArray.h>

#include <string>

#include "haptex/base/finger.h"
#include "haptex/tactile/channels.h"

namespace haptex::nodes {

/// The amplitude that has the last colour of viridis, um: comfortable levels are a few tens of
/// micrometres near 50 Hz and a few near 300 Hz.
constexpr tactile::PerChannel<double> kFullAmplitude{40.0, 10.0};

/// Where on the colour map an amplitude (um) lies: logarithmic over two decades up to
/// kFullAmplitude, so that silk and canvas are seen on the same scale.
double amplitudeFraction(tactile::Channel channel, double amplitude);

/// Above the panel of a channel, for example "index 40 Hz\n3.2 um of 40".
/// @param amplitude the largest one of the array, um
std::string panelCaption(base::Finger finger, tactile::Channel channel, double amplitude);

/// Heat maps of both channels of every contactor, in namespaces that rviz can switch off singly:
/// "tactile_pads": at true size on the fingertips, in the frames <finger>_tactile; of each
///   contactor the proximal half is the channel of 40 Hz and the distal half that of 320 Hz.
/// "tactile_panels": enlarged, in the frame fixedFrame() beside the sample, turned to the viewer of
///   rviz/haptex.rviz. A panel shows the pad with the fingertip upwards, as its owner would see
///   it who looks at it.
/// "tactile_captions": what the panels are, and the rate of the renderer.
class TactileMarkers {
 public:
  TactileMarkers();

  /// Valid until the next call.
  /// @param rate of the renderer, Hz; NaN if it is not known yet
  const visualization_msgs::MarkerArray& update(const base::PerFinger<haptex::Tactile>& tactile,
                                                double rate, const ros::Time& stamp);

 private:
  visualization_msgs::MarkerArray markers_;
};

}  // namespace haptex::nodes
