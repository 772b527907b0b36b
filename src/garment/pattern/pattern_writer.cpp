// Writes garment files.
#include <charconv>
#include <cmath>
#include <sstream>

#include "haptex/garment/pattern/pattern_file.h"

namespace haptex::garment {
namespace {

std::string quoted(const std::string& text) {
  std::ostringstream out;
  out << '"';
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out << '\\' << c;
    } else if (code < 0x20) {
      const char* digits = "0123456789abcdef";
      out << "\\x" << digits[code >> 4] << digits[code & 15];
    } else {
      out << c;
    }
  }
  out << '"';
  return out.str();
}

// The shortest that reads as the same number.
std::string number(double value) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, value == 0.0 ? 0.0 : value).ptr;
  return std::string(digits, end);
}

template <typename Vector>
std::string list(const Vector& vector) {
  std::string text = "[";
  for (int i = 0; i < vector.size(); ++i) text += (i == 0 ? "" : ", ") + number(vector[i]);
  return text + "]";
}

// Roll, pitch and yaw of R = Rz(yaw) Ry(pitch) Rx(roll), to 1e-12 rad: so they stay the same when
// they are read and written again.
Eigen::Vector3d rollPitchYaw(const Eigen::Matrix3d& r) {
  const double across = std::hypot(r(0, 0), r(1, 0));
  Eigen::Vector3d angles(std::atan2(r(2, 1), r(2, 2)), std::atan2(-r(2, 0), across),
                         std::atan2(r(1, 0), r(0, 0)));
  if (across < 1e-12) angles << std::atan2(-r(1, 2), r(1, 1)), angles.y(), 0.0;
  return (angles * 1e12).array().round() / 1e12;
}

void writePoints(const std::vector<Eigen::Vector2d>& points, const std::string& indent,
                 std::ostream& out) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i > 0) out << (i % 4 == 0 ? ",\n" + indent : ", ");
    out << list(points[i]);
  }
}

void writeOutline(const Outline& outline, const std::string& first, const std::string& indent,
                  std::ostream& out) {
  const char* const kinds[] = {"line", "quadratic", "cubic", "arc"};
  std::string before = first;
  for (const Edge& edge : outline) {
    out << before << "- {" << kinds[static_cast<int>(edge.curve.kind())] << ": [";
    writePoints(edge.curve.points(), indent + "    ", out);
    out << ']';
    if (!edge.name.empty()) out << ", name: " << quoted(edge.name);
    out << "}\n";
    before = indent;
  }
}

void writePlacement(const Panel& panel, std::ostream& out) {
  if (const auto* on = std::get_if<OnCarrier>(&panel.placement)) {
    out << "    placement: {carrier: " << quoted(on->carrier);
    if (on->angle) out << ", angle: " << number(*on->angle);
    if (on->along) out << ", along: " << number(*on->along);
    if (on->turn != 0.0) out << ", turn: " << number(on->turn);
    out << "}\n";
    return;
  }
  const auto& pose = std::get<Eigen::Isometry3d>(panel.placement);
  out << "    placement: {position: " << list(pose.translation())
      << ", rpy: " << list(rollPitchYaw(pose.linear())) << "}\n";
}

void writePanel(const Panel& panel, std::ostream& out) {
  out << "  - name: " << quoted(panel.name) << "\n    fabric: " << quoted(panel.fabric) << '\n';
  if (panel.layer != 0) out << "    layer: " << panel.layer << '\n';
  out << "    grain: " << list(panel.warp) << '\n';
  writePlacement(panel, out);
  out << "    outline:\n";
  writeOutline(panel.outlines.front(), "      ", "      ", out);
  if (panel.outlines.size() > 1) out << "    holes:\n";
  for (std::size_t k = 1; k < panel.outlines.size(); ++k) {
    writeOutline(panel.outlines[k], "      - ", "        ", out);
  }
  if (!panel.marks.empty()) out << "    marks:\n";
  for (const auto& mark : panel.marks) {
    out << "      - [";
    writePoints(mark, "         ", out);
    out << "]\n";
  }
}

std::string edgeName(const Edge& edge, int index) {
  return edge.name.empty() ? std::to_string(index) : quoted(edge.name);
}

void writeSide(const Pattern& pattern, const SeamSide& side, std::ostream& out) {
  const Panel& panel = pattern.panels[side.panel];
  const Outline& outline = panel.outlines[side.outline];
  out << "{panel: " << quoted(panel.name);
  if (side.outline > 0) out << ", hole: " << side.outline - 1;
  out << ", edges: [" << edgeName(outline[side.first], side.first);
  if (side.first != side.last) out << ", " << edgeName(outline[side.last], side.last);
  out << ']' << (side.reversed ? ", reversed: true" : "") << '}';
}

}  // namespace

std::string writePattern(const Pattern& pattern) {
  std::ostringstream out;
  out << "source: " << quoted(pattern.source) << '\n';
  if (!pattern.carriers.empty()) out << "carriers:\n";
  for (const Carrier& carrier : pattern.carriers) {
    const bool cone = carrier.shape == Carrier::Shape::kCone;
    out << "  - {name: " << quoted(carrier.name) << ", shape: " << (cone ? "cone" : "cylinder")
        << ", segment: " << quoted(carrier.segment) << "}\n";
  }
  out << "panels:\n";
  for (const Panel& panel : pattern.panels) writePanel(panel, out);
  if (!pattern.seams.empty()) out << "seams:\n";
  for (const Seam& seam : pattern.seams) {
    out << "  - sides: [";
    writeSide(pattern, seam.sides[0], out);
    out << ",\n            ";
    writeSide(pattern, seam.sides[1], out);
    out << "]\n    easing: " << number(seam.easing) << '\n';
  }
  if (!pattern.fastenings.empty()) out << "fasteners:\n";
  for (const Fastening& fastening : pattern.fastenings) {
    out << "  - name: " << quoted(fastening.name) << "\n    between: [";
    for (const PlaceOnPanel& place : fastening.places) {
      if (&place != &fastening.places.front()) out << ",\n              ";
      out << "{panel: " << quoted(pattern.panels[place.panel].name) << ", at: " << list(place.at)
          << '}';
    }
    out << "]\n";
  }
  return out.str();
}

}  // namespace haptex::garment
