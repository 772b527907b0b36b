#include "haptex/nodes/tactile_renderer/tactile_markers.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "haptex/nodes/common/vector_messages.h"
#include "haptex/nodes/markers/colour_map.h"
#include "haptex/nodes/markers/marker_shapes.h"
#include "haptex/nodes/wire/frame_names.h"
#include "haptex/realtime/rate_meter.h"
#include "haptex/tactile/contactor_array.h"

namespace haptex::nodes {
namespace {

using base::Finger;
using base::kFingers;
using tactile::Channel;
using visualization_msgs::Marker;

constexpr Channel kBothChannels[] = {tactile::k40, tactile::k320};

// Indices of the first marker of a kind; there is one for each finger, and within that one for each
// channel.
constexpr int kPads = 0;
constexpr int kPanels = 2;
constexpr int kCaptions = 6;
constexpr int kRate = 10;

constexpr int kDecades = 2;            // that the colours span
constexpr double kPadHeight = 0.0015;  // m, above the origin: the array drawn is 1.2 mm high there
constexpr double kCellShare = 0.9;     // of a cell that is filled, along each edge
constexpr double kPanelCell = 0.012;   // m
constexpr double kTextHeight = 0.009;  // m, of a line
constexpr double kLine = 2.7;          // rviz's line spacing, of kTextHeight
const Eigen::Vector3f kTextColour(0.1F, 0.1F, 0.1F);

// The first panel in world, to the left of the sample in the view of rviz/haptex.rviz, and how the
// panels stand there.
const Eigen::Vector3d kPanelPlace(0.191, -0.142, -0.072);
constexpr double kViewerYaw = 1.0;     // rad
constexpr double kViewerPitch = 0.2;   // rad
constexpr double kPanelColumn = 0.08;  // m, from channel to channel
constexpr double kPanelRow = 0.13;     // m, from finger to finger
const Eigen::Vector3d kRight(-std::sin(kViewerYaw), std::cos(kViewerYaw), 0.0);
const Eigen::Vector3d kUp(-std::cos(kViewerYaw) * std::sin(kViewerPitch),
                          -std::sin(kViewerYaw) * std::sin(kViewerPitch), std::cos(kViewerPitch));

constexpr int indexOf(Finger finger, Channel channel) {
  return tactile::kChannels * static_cast<int>(finger) + channel;
}

/// @param right, up whole edges, m
void appendRectangle(const Eigen::Vector3d& middle, const Eigen::Vector3d& right,
                     const Eigen::Vector3d& up, Marker& marker) {
  const auto corner = [&](double x, double y) {
    marker.points.push_back(pointMessage(middle + 0.5 * x * right + 0.5 * y * up));
  };
  corner(-1, -1), corner(1, -1), corner(1, 1);
  corner(-1, -1), corner(1, 1), corner(-1, 1);
  marker.colors.resize(marker.points.size());
}

void paintRectangle(int index, const Eigen::Vector3f& colour, Marker& marker) {
  std::fill_n(marker.colors.begin() + 6 * index, 6, colourMessage(colour));
}

/// Per contactor a rectangle for each channel.
Marker makePad(Finger finger) {
  Marker marker = makeMarker("tactile_pads", static_cast<int>(finger), Marker::TRIANGLE_LIST);
  marker.header.frame_id = arrayFrame(finger);
  marker.frame_locked = true;  // and its stamp 0: it stays in this frame
  const double cell = tactile::kContactorSpacing;
  for (int i = 0; i < tactile::kContactors; ++i) {
    const Eigen::Vector2d place = tactile::contactorPlace(i);
    for (const Channel channel : kBothChannels) {
      const double x = place.x() + (channel == tactile::k40 ? -0.25 : 0.25) * kCellShare * cell;
      appendRectangle({x, place.y(), kPadHeight}, {0.5 * kCellShare * cell, 0.0, 0.0},
                      {0.0, kCellShare * cell, 0.0}, marker);
    }
  }
  return marker;
}

Eigen::Vector3d panelMiddle(Finger finger, Channel channel) {
  return kPanelPlace + (channel == tactile::k40 ? 0.0 : kPanelColumn) * kRight -
         (finger == Finger::kIndex ? 0.0 : kPanelRow) * kUp;
}

/// Seen from outside of the pad, z towards the viewer and x upwards, y is to the left.
Marker makePanel(Finger finger, Channel channel) {
  Marker marker = makeMarker("tactile_panels", indexOf(finger, channel), Marker::TRIANGLE_LIST);
  const double scale = kPanelCell / tactile::kContactorSpacing;
  for (int i = 0; i < tactile::kContactors; ++i) {
    const Eigen::Vector2d place = scale * tactile::contactorPlace(i);
    appendRectangle(panelMiddle(finger, channel) - place.y() * kRight + place.x() * kUp,
                    kCellShare * kPanelCell * kRight, kCellShare * kPanelCell * kUp, marker);
  }
  return marker;
}

Marker makeText(int id, const Eigen::Vector3d& place) {
  Marker marker = makeMarker("tactile_captions", id, Marker::TEXT_VIEW_FACING);
  marker.pose.position = pointMessage(place);
  marker.scale.z = kTextHeight;
  marker.color = colourMessage(kTextColour);
  return marker;
}

/// Above the first row of a panel, two lines.
Eigen::Vector3d captionPlace(Finger finger, Channel channel) {
  return panelMiddle(finger, channel) +
         (0.5 * tactile::kContactorColumns * kPanelCell + (0.5 * kLine + 0.8) * kTextHeight) * kUp;
}

const haptex::Tactile::_amplitudes_40_type& amplitudesOf(const haptex::Tactile& tactile,
                                                         Channel channel) {
  return channel == tactile::k40 ? tactile.amplitudes_40 : tactile.amplitudes_320;
}

}  // namespace

double amplitudeFraction(Channel channel, double amplitude) {
  return amplitude > 0.0 ? 1.0 + std::log10(amplitude / kFullAmplitude[channel]) / kDecades : 0.0;
}

std::string panelCaption(Finger finger, Channel channel, double amplitude) {
  char text[64];
  std::snprintf(text, sizeof(text), "%s %.0f Hz\n%.1f um of %.0f", base::name(finger),
                tactile::kChannelFrequencies[channel], amplitude, kFullAmplitude[channel]);
  return text;
}

TactileMarkers::TactileMarkers() {
  auto& markers = markers_.markers;
  for (const Finger finger : kFingers) markers.push_back(makePad(finger));
  for (const Finger finger : kFingers) {
    for (const Channel channel : kBothChannels) markers.push_back(makePanel(finger, channel));
  }
  for (const Finger finger : kFingers) {
    for (const Channel channel : kBothChannels) {
      markers.push_back(makeText(indexOf(finger, channel), captionPlace(finger, channel)));
    }
  }
  const Eigen::Vector3d first = captionPlace(Finger::kIndex, tactile::k40);
  markers.push_back(makeText(
      kRate - kCaptions, first + 0.5 * kPanelColumn * kRight + 1.8 * kLine * kTextHeight * kUp));
}

const visualization_msgs::MarkerArray& TactileMarkers::update(
    const base::PerFinger<haptex::Tactile>& tactile, double rate, const ros::Time& stamp) {
  auto& markers = markers_.markers;
  for (const Finger finger : kFingers) {
    for (const Channel channel : kBothChannels) {
      const auto& amplitudes = amplitudesOf(tactile[finger], channel);
      for (int i = 0; i < tactile::kContactors; ++i) {
        const Eigen::Vector3f colour = viridis(amplitudeFraction(channel, amplitudes[i]));
        paintRectangle(tactile::kChannels * i + channel, colour,
                       markers[kPads + static_cast<int>(finger)]);
        paintRectangle(i, colour, markers[kPanels + indexOf(finger, channel)]);
      }
      markers[kCaptions + indexOf(finger, channel)].text =
          panelCaption(finger, channel, *std::max_element(amplitudes.begin(), amplitudes.end()));
    }
  }
  markers[kRate].text = realtime::rateLine("tactile renderer", rate);
  for (int i = kPanels; i <= kRate; ++i) markers[i].header.stamp = stamp;
  return markers_;
}

}  // namespace haptex::nodes
