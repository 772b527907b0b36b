// Fabric files that live as long as a test, and what is refused in them.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <ostream>
#include <stdexcept>
#include <string>

#include "haptex/material/fabric_file.h"

namespace haptex::material {

class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& text)
      : path_(testing::TempDir() + "haptex_fabric_" + std::to_string(getpid()) + ".yaml") {
    std::ofstream(path_) << text;
  }
  ~TemporaryFile() { std::remove(path_.c_str()); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

// Not inline: Clang 14 makes inline ones of each other in any order.
const std::string kHead = R"(name: sample
areal_density: {value: 0.2, unit: kg/m2, provenance: measured, source: scales}
)";
const std::string kWeft = R"(weft:
  elastic: {unit: N/m, provenance: measured, source: tester, modulus: 100}
)";
const std::string kWarp = R"(warp:
  elastic:
    unit: N/m
    provenance: measured
    source: tester
    quantity: force_per_width_over_engineering_strain
    points: [[0, 0], [0.1, 11], [0.2, 24]]
  viscous: {unit: N.s/m, provenance: representative, source: a guess, modulus: 2.5}
)";
const std::string kShear = R"(shear:
  elastic:
    unit: N/m
    provenance: representative
    source: a similar fabric
    quantity: second_piola_kirchhoff_over_green_lagrange
    points: [[0.1, 4], [0.2, 10]]
)";
const std::string kValid = kHead + kWeft + kWarp + kShear;
const std::string kContact =
    R"(bending: {unit: N.m, provenance: measured, source: KES-FB2, weft: 6e-6, warp: 9e-6}
compression:
  unit: m and J/m2
  provenance: measured
  source: KES-FB3
  kes: {T0: 7e-4, Tm: 4.5e-4, WC: 0.2}
friction: {provenance: representative, source: a guess, value: 0.25}
)";
const std::string kFull = kValid + kContact;

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << "the test replaces what is not there: " << from;
  return text.replace(at, from.size(), to);
}

struct Refusal {
  std::string name;
  std::string from, to;   // the change that makes the valid file invalid
  std::string key_path;   // named in the message
  std::string complaint;  // the rest of it
};

inline void PrintTo(const Refusal& refusal, std::ostream* stream) { *stream << refusal.name; }

/// Expects that `valid` with the change is refused, naming file, key, value and what is allowed,
/// and that nothing half-read reaches the caller.
inline void expectRefusal(const std::string& valid, const Refusal& refusal) {
  const TemporaryFile file(replaced(valid, refusal.from, refusal.to));
  Fabric fabric;
  fabric.name = "before";
  fabric.areal_density = 0.7;
  try {
    fabric = loadFabric(file.path());
    ADD_FAILURE() << "not refused";
  } catch (const std::invalid_argument& error) {
    const std::string key = refusal.key_path.empty() ? "" : refusal.key_path + ": ";
    EXPECT_EQ(error.what(), file.path() + ": " + key + refusal.complaint);
  }
  EXPECT_EQ(fabric.name, "before");
  EXPECT_EQ(fabric.areal_density, 0.7);
  EXPECT_TRUE(fabric.provenance.empty());
}

/// As a key of the bending.
inline std::string hysteresisOf(const std::string& unit, const std::string& weft) {
  return "hysteresis: {unit: " + unit + ", provenance: measured, source: its loops, weft: " + weft +
         ", warp: 2e-4}";
}

/// As a key of the shear.
inline std::string shearHysteresisOf(const std::string& unit, const std::string& at_half_degree) {
  return "  hysteresis: {unit: " + unit +
         ", provenance: measured, source: its loops, 2HG: " + at_half_degree + ", 2HG5: 1.5}\n";
}

inline std::string resilienceOf(const std::string& weft) {
  return "resilience: {provenance: measured, source: KES-FB1, weft: " + weft + ", warp: 0.7}\n";
}

}  // namespace haptex::material
