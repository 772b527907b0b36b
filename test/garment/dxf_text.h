// Makes DXF files for tests.
#pragma once

#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace haptex::garment {

/// The text of a drawing, entity by entity.
class DxfText {
 public:
  using Points = std::vector<std::pair<double, double>>;

  explicit DxfText(const std::string& units = "METRIC") {
    group(0, "SECTION").group(2, "HEADER").group(9, "$ACADVER").group(1, "AC1009");
    group(0, "ENDSEC").group(0, "SECTION").group(2, "BLOCKS");
    units_ = units;
  }

  DxfText& block(const std::string& name) {
    if (open_) group(0, "ENDBLK");
    open_ = true;
    return group(0, "BLOCK").group(8, "1").group(2, name).group(70, "64");
  }
  DxfText& polyline(const std::string& layer, const Points& points, bool closed = true) {
    group(0, "POLYLINE").group(8, layer).group(66, "1").group(70, closed ? "1" : "0");
    for (const auto& point : points) group(0, "VERTEX").group(8, layer).at(10, point);
    return group(0, "SEQEND");
  }
  DxfText& line(const std::string& layer, std::pair<double, double> a,
                std::pair<double, double> b) {
    return group(0, "LINE").group(8, layer).at(10, a).at(11, b);
  }
  DxfText& point(const std::string& layer, std::pair<double, double> at_point) {
    return group(0, "POINT").group(8, layer).at(10, at_point);
  }
  DxfText& text(const std::string& words) {
    return group(0, "TEXT").group(8, "1").at(10, {0.0, 0.0}).group(40, "5").group(1, words);
  }
  DxfText& group(int code, const std::string& value) {
    text_ << code << "\r\n" << value << "\r\n";
    return *this;
  }

  std::string str() const {
    DxfText end = *this;
    if (open_) end.group(0, "ENDBLK");
    end.group(0, "ENDSEC").group(0, "SECTION").group(2, "ENTITIES");
    if (!units_.empty()) end.text("Units: " + units_);
    end.group(0, "ENDSEC").group(0, "EOF");
    return end.text_.str();
  }

  DxfText(const DxfText& other) : units_(other.units_), open_(other.open_) {
    text_ << other.text_.str();
  }

 private:
  DxfText& at(int code, std::pair<double, double> point) {
    std::ostringstream x, y;
    x << point.first;
    y << point.second;
    return group(code, x.str()).group(code + 10, y.str());
  }

  std::ostringstream text_;
  std::string units_;
  bool open_ = false;
};

/// Front and back of a skirt, 200 and 201 mm high: the front is a half, with a drill hole, drawn in
/// millimetres.
inline std::string smallDxf() {
  return DxfText()
      .block("FRONT-M")
      .text("Piece Name: front")
      .text("Quantity: 1")
      .polyline("1", {{0, 0}, {120, 0}, {110, 200}, {0, 200}, {0, 0}}, false)
      .line("6", {0, 0}, {0, 200})
      .line("7", {50, 20}, {50, 180})
      .point("4", {60, 200})
      .point("13", {30, 100})
      .polyline("8", {{20, 50}, {40, 50}}, false)
      .polyline("11", {{60, 80}, {80, 80}, {70, 100}})
      .block("BACK-M")
      .text("Piece Name: back")
      .text("Quantity: 2")
      .polyline("1", {{290, -10}, {550, -10}, {550, 210}, {290, 210}})
      .polyline("14", {{300, 0}, {540, 0}, {540, 100}, {542, 150}, {540, 201}, {300, 201}})
      .point("2", {300, 0})
      .point("2", {540, 0})
      .point("2", {540, 201})
      .point("2", {300, 201})
      .line("7", {400, 180}, {400, 20})
      .str();
}

}  // namespace haptex::garment
