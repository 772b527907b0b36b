#include "haptex/material/fabric_writer.h"

#include <yaml-cpp/yaml.h>

#include <ostream>

namespace haptex::material {
namespace {

class Writer {
 public:
  Writer(const TesterFabric& fabric, std::ostream& out) : fabric_(fabric), out_(out), yaml_(out) {
    yaml_.SetDoublePrecision(12);
  }

  void write() {
    for (const std::string& remark : fabric_.remarks)
      yaml_ << YAML::Comment(remark) << YAML::Newline;
    yaml_ << YAML::BeginMap;
    add("name", fabric_.name);
    begin("areal_density");
    add("value", fabric_.areal_density.value);
    addOrigin("kg/m2", fabric_.areal_density.source);
    end();
    begin("weft");
    writeCurve(fabric_.weft);
    end();
    begin("warp");
    writeCurve(fabric_.warp);
    end();
    writeShear();
    if (const auto& resilience = fabric_.resilience) {
      begin("resilience");
      addOrigin(nullptr, resilience->source);
      addBoth(resilience->value);
      end();
    }
    writeBending();
    if (fabric_.compression) writeCompression(*fabric_.compression);
    if (const auto& friction = fabric_.friction) {
      begin("friction");
      addOrigin(nullptr, friction->source);
      add("value", friction->value);
      end();
    }
    yaml_ << YAML::EndMap;
    out_ << '\n';
  }

 private:
  template <typename Value>
  void add(const char* key, const Value& value) {
    yaml_ << YAML::Key << key << YAML::Value << value;
  }
  template <typename Both>
  void addBoth(const Both& value) {
    add("weft", value.weft);
    add("warp", value.warp);
  }
  void begin(const char* key) { yaml_ << YAML::Key << key << YAML::Value << YAML::BeginMap; }
  void end() { yaml_ << YAML::EndMap; }

  void addOrigin(const char* unit, const std::string& source) {
    if (unit != nullptr) add("unit", unit);
    add("provenance", fabric_.measured ? "measured" : "representative");
    add("source", source);
  }

  /// One row of numbers per line.
  template <typename Rows>
  void addRows(const char* key, const Rows& rows) {
    yaml_ << YAML::Key << key << YAML::Value << YAML::BeginSeq;
    for (const auto& row : rows) {
      yaml_ << YAML::Flow << YAML::BeginSeq;
      for (const double number : row) yaml_ << number;
      yaml_ << YAML::EndSeq;
    }
    yaml_ << YAML::EndSeq;
  }

  void writeCurve(const Sourced<StatedCurve>& curve) {
    begin("elastic");
    addOrigin("N/m", curve.source);
    if (const auto* modulus = std::get_if<double>(&curve.value)) {
      add("modulus", *modulus);
    } else if (const auto* points = std::get_if<std::vector<CurvePoint>>(&curve.value)) {
      add("quantity", "force_per_width_over_engineering_strain");
      std::vector<std::array<double, 2>> rows;
      for (const auto& [strain, stress] : *points) rows.push_back({strain, stress});
      addRows("points", rows);
    } else {
      const auto& cubic = std::get<PiecewiseCubic>(curve.value);
      begin("polynomials");
      yaml_ << YAML::Key << "knots" << YAML::Value << YAML::Flow << cubic.knots;
      addRows("coefficients", cubic.coefficients);
      end();
    }
    end();
  }

  void writeShear() {
    begin("shear");
    writeCurve(fabric_.shear);
    if (const auto& hysteresis = fabric_.shear_hysteresis) {
      begin("hysteresis");
      addOrigin("N/m", hysteresis->source);
      add("2HG", hysteresis->value.at_half_degree);
      add("2HG5", hysteresis->value.at_five_degrees);
      end();
    }
    end();
  }

  void writeBending() {
    const auto& bending = fabric_.bending;
    if (!bending) return;
    begin("bending");
    addOrigin("N.m", bending->source);
    addBoth(bending->value);
    if (const auto& hysteresis = fabric_.bending_hysteresis) {
      begin("hysteresis");
      addOrigin("N", hysteresis->source);
      addBoth(hysteresis->value);
      end();
    }
    end();
  }

  void writeCompression(const Sourced<StatedCompression>& compression) {
    begin("compression");
    if (const auto* kes = std::get_if<KesCompression>(&compression.value)) {
      addOrigin("m and J/m2", compression.source);
      begin("kes");
      add("T0", kes->low_pressure_thickness);
      add("Tm", kes->high_pressure_thickness);
      add("WC", kes->work);
      end();
    } else {
      addOrigin("Pa and m", compression.source);
      std::vector<std::array<double, 2>> rows;
      for (const auto& [pressure, thickness] :
           std::get<std::vector<ThicknessPoint>>(compression.value)) {
        rows.push_back({pressure, thickness});
      }
      addRows("points", rows);
    }
    end();
  }

  const TesterFabric& fabric_;
  std::ostream& out_;
  YAML::Emitter yaml_;
};

}  // namespace

void writeFabric(const TesterFabric& fabric, std::ostream& out) { Writer(fabric, out).write(); }

}  // namespace haptex::material
