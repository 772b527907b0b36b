#include "haptex/garment/importers/dxf_reader.h"

#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "haptex/base/parse_number.h"
#include "haptex/base/require.h"

namespace haptex::garment {
namespace {

using base::refuse;
using Eigen::Vector2d;

constexpr double kFarthest = 1e9;  // in the drawing's unit

struct Group {
  int code = 0;
  std::string_view value;
  std::size_t line = 0;  // of the value, from 1
};

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == text.npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

/// Pairs of a group code and a value.
class GroupReader {
 public:
  GroupReader(std::string_view text, std::string name) : rest_(text), name_(std::move(name)) {
    if (text.substr(0, 18) == "AutoCAD Binary DXF") {
      refuse(name_, ": is a binary DXF file: allowed are those in ASCII");
    }
  }

  /// Nothing at the end of the text.
  std::optional<Group> next() {
    const auto code = nextLine();
    if (!code || (code->empty() && rest_.empty())) return std::nullopt;
    Group group;
    group.code = parsed<int>(*code, "a group code, a whole number");
    const auto value = nextLine();
    if (!value) refuse(name_, ": line ", line_, ": ends after the group code ", group.code);
    group.value = *value;
    group.line = line_;
    return group;
  }

  double number(const Group& group) const {
    const double number = parsed<double>(group.value, "a number");
    if (!(std::abs(number) <= kFarthest)) {
      refuse(name_, ": line ", group.line, ": ", number, ": allowed are numbers up to ", kFarthest);
    }
    return number;
  }
  int integer(const Group& group) const { return parsed<int>(group.value, "a whole number"); }

  [[noreturn]] void refuseAt(const Group& group, const std::string& what) const {
    refuse(name_, ": line ", group.line, ": ", what);
  }

 private:
  std::optional<std::string_view> nextLine() {
    if (rest_.empty()) return std::nullopt;
    ++line_;
    const std::size_t end = rest_.find('\n');
    const std::string_view line = trimmed(rest_.substr(0, end));
    rest_ = end == rest_.npos ? std::string_view() : rest_.substr(end + 1);
    return line;
  }

  template <typename Number>
  Number parsed(std::string_view text, const char* what) const {
    const auto number = base::parseNumber<Number>(base::withoutPlus(text));
    if (!number) {
      refuse(name_, ": line ", line_, ": '", std::string(text.substr(0, 40)), "' must be ", what);
    }
    return *number;
  }

  std::string_view rest_;
  std::string name_;
  std::size_t line_ = 0;
};

// The arc from a to b whose bulge is the tangent of a quarter of its angle, counter-clockwise.
void addArc(const Vector2d& a, const Vector2d& b, double bulge, std::vector<Vector2d>& points) {
  const Vector2d chord = b - a;
  if (bulge == 0.0 || !(std::abs(bulge) < 1e3) || chord.norm() == 0.0) return;
  const double angle = 4.0 * std::atan(bulge);
  const Vector2d left(-chord.y(), chord.x());
  const Vector2d centre = 0.5 * (a + b) + left * ((1.0 - bulge * bulge) / (4.0 * bulge));
  const double radius = (a - centre).norm() / chord.norm();
  const double step = std::sqrt(8.0 * 1e-5 / radius);
  const int count = 1 + static_cast<int>(std::min(2000.0, std::abs(angle) / step));
  for (int i = 1; i < count; ++i) {
    const double turn = angle * i / count;
    const Vector2d from = a - centre;
    points.push_back(centre + Vector2d(from.x() * std::cos(turn) - from.y() * std::sin(turn),
                                       from.x() * std::sin(turn) + from.y() * std::cos(turn)));
  }
}

struct BulgedPoint {
  Vector2d at = Vector2d::Zero();
  double bulge = 0.0;
};

class DxfReader {
 public:
  DxfReader(const std::string& text, const std::string& name) : groups_(text, name), name_(name) {}

  DxfDrawing read() {
    advance();
    while (group_ && !is(0, "EOF")) {
      if (!is(0, "SECTION")) {
        advance();
        continue;
      }
      advance();
      if (is(2, "HEADER")) {
        readHeader();
      } else if (is(2, "BLOCKS")) {
        readBlocks();
        requireEnd("BLOCKS");
      } else if (is(2, "ENTITIES")) {
        readEntities(drawing_.entities);
        requireEnd("ENTITIES");
      }
    }
    if (!any_section_) refuse(name_, ": has no section BLOCKS or ENTITIES: is it a DXF file?");
    return std::move(drawing_);
  }

 private:
  void advance() { group_ = groups_.next(); }
  bool is(int code, std::string_view value) const {
    return group_ && group_->code == code && group_->value == value;
  }
  void requireEnd(const char* section) const {
    if (!group_) refuse(name_, ": ends within the section ", section, ", without ENDSEC");
  }
  bool atEntity() const { return group_ && group_->code == 0; }

  void readHeader() {
    bool units = false;
    for (advance(); group_ && !is(0, "ENDSEC"); advance()) {
      if (group_->code == 9) units = group_->value == "$INSUNITS";
      if (group_->code == 70 && units) drawing_.unit = groups_.integer(*group_);
    }
  }

  void readBlocks() {
    any_section_ = true;
    advance();
    while (group_ && !is(0, "ENDSEC")) {
      if (!is(0, "BLOCK")) {
        advance();
        continue;
      }
      DxfBlock& block = drawing_.blocks.emplace_back();
      for (advance(); group_ && group_->code != 0; advance()) {
        if (group_->code == 2) block.name = group_->value;
      }
      readEntities(block.entities);
    }
  }

  // Up to the end of the block or section.
  void readEntities(std::vector<DxfEntity>& entities) {
    any_section_ = true;
    if (!atEntity()) advance();
    while (group_ && !is(0, "ENDBLK") && !is(0, "ENDSEC")) {
      if (is(0, "POINT")) {
        readSimple(DxfEntity::Kind::kPoint, entities);
      } else if (is(0, "LINE")) {
        readSimple(DxfEntity::Kind::kLine, entities);
      } else if (is(0, "TEXT")) {
        readSimple(DxfEntity::Kind::kText, entities);
      } else if (is(0, "POLYLINE")) {
        readPolyline(entities);
      } else if (is(0, "LWPOLYLINE")) {
        readLightPolyline(entities);
      } else {
        advance();
      }
    }
  }

  void readSimple(DxfEntity::Kind kind, std::vector<DxfEntity>& entities) {
    DxfEntity entity;
    entity.kind = kind;
    Vector2d first = Vector2d::Zero(), second = Vector2d::Zero();
    for (advance(); group_ && group_->code != 0; advance()) {
      switch (group_->code) {
        case 1:
          entity.text = group_->value;
          break;
        case 8:
          entity.layer = group_->value;
          break;
        case 10:
          first.x() = groups_.number(*group_);
          break;
        case 20:
          first.y() = groups_.number(*group_);
          break;
        case 11:
          second.x() = groups_.number(*group_);
          break;
        case 21:
          second.y() = groups_.number(*group_);
          break;
        default:
          break;
      }
    }
    entity.points = {first};
    if (kind == DxfEntity::Kind::kLine) entity.points.push_back(second);
    entities.push_back(std::move(entity));
  }

  void readPolyline(std::vector<DxfEntity>& entities) {
    DxfEntity entity;
    entity.kind = DxfEntity::Kind::kPolyline;
    const Group begin = *group_;
    for (advance(); group_ && group_->code != 0; advance()) {
      if (group_->code == 8) entity.layer = group_->value;
      if (group_->code == 70) entity.closed = (groups_.integer(*group_) & 1) != 0;
    }
    std::vector<BulgedPoint> points;
    while (is(0, "VERTEX")) {
      BulgedPoint& point = points.emplace_back();
      for (advance(); group_ && group_->code != 0; advance()) {
        if (group_->code == 10) point.at.x() = groups_.number(*group_);
        if (group_->code == 20) point.at.y() = groups_.number(*group_);
        if (group_->code == 42) point.bulge = groups_.number(*group_);
      }
    }
    if (!is(0, "SEQEND")) groups_.refuseAt(begin, "a POLYLINE without SEQEND");
    advance();
    addPolyline(begin, std::move(entity), points, entities);
  }

  void readLightPolyline(std::vector<DxfEntity>& entities) {
    DxfEntity entity;
    entity.kind = DxfEntity::Kind::kPolyline;
    const Group begin = *group_;
    std::vector<BulgedPoint> points;
    for (advance(); group_ && group_->code != 0; advance()) {
      if (group_->code == 8) entity.layer = group_->value;
      if (group_->code == 70) entity.closed = (groups_.integer(*group_) & 1) != 0;
      if (group_->code == 10) points.emplace_back().at.x() = groups_.number(*group_);
      if (points.empty()) continue;
      if (group_->code == 20) points.back().at.y() = groups_.number(*group_);
      if (group_->code == 42) points.back().bulge = groups_.number(*group_);
    }
    addPolyline(begin, std::move(entity), points, entities);
  }

  void addPolyline(const Group& begin, DxfEntity entity, const std::vector<BulgedPoint>& points,
                   std::vector<DxfEntity>& entities) const {
    if (points.size() < 2) {
      groups_.refuseAt(begin, "a polyline of " + std::to_string(points.size()) +
                                  " points: allowed are 2 or more");
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      entity.points.push_back(points[i].at);
      const bool last = i + 1 == points.size();
      if (last && !entity.closed) break;
      addArc(points[i].at, points[last ? 0 : i + 1].at, points[i].bulge, entity.points);
    }
    entities.push_back(std::move(entity));
  }

  GroupReader groups_;
  const std::string& name_;
  std::optional<Group> group_;
  bool any_section_ = false;
  DxfDrawing drawing_;
};

}  // namespace

DxfDrawing readDxf(const std::string& text, const std::string& name) {
  return DxfReader(text, name).read();
}

}  // namespace haptex::garment
