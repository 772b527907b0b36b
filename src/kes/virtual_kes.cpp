#include "haptex/kes/virtual_kes.h"

#include <cmath>
#include <ostream>
#include <stdexcept>

#include "haptex/base/quoted.h"

namespace haptex::kes {

double KesParameter::error() const {
  const double difference = measured - put_in;
  return put_in == 0.0 ? difference : difference / put_in;
}

const std::vector<KesTest>& kesTests() {
  using material::Fabric;
  static const std::vector<KesTest> tests = {
      {"tensile", [](const Fabric&) { return true; }, kesTensile},
      {"shear", [](const Fabric&) { return true; }, kesShear},
      {"bending", [](const Fabric& fabric) { return fabric.bending.has_value(); }, kesBending},
      {"compression", [](const Fabric& fabric) { return fabric.compression && fabric.friction; },
       kesCompression},
      {"surface", [](const Fabric& fabric) { return fabric.surface && fabric.compression; },
       kesSurface}};
  return tests;
}

void printKes(const material::Fabric& fabric, const std::string& test, std::ostream& out) {
  std::string names;
  bool found = test.empty();
  for (const KesTest& each : kesTests()) {
    names += " " + each.name;
    found = found || each.name == test;
  }
  if (!found)
    throw std::invalid_argument("there is no test " + base::quoted(test) + "; there are:" + names);
  out.precision(8);
  out << "# fabric " << fabric.name << '\n';
  for (const KesTest& each : kesTests()) {
    if (!test.empty() && each.name != test) continue;
    if (test.empty() && !each.possible(fabric)) {
      out << "# " << each.name << ": the fabric file lacks what the test is about\n";
      continue;
    }
    const KesResult result = each.run(fabric);
    for (const KesPoint& point : result.points) {
      out << "curve\t" << point.test << '\t' << point.direction << '\t' << point.x << '\t'
          << point.simulated << '\t' << point.put_in << '\n';
    }
    for (const KesParameter& parameter : result.parameters) {
      out << "parameter\t" << parameter.name << '\t' << parameter.unit << '\t' << parameter.put_in
          << '\t' << parameter.measured << '\t' << parameter.error() << '\n';
    }
    out.flush();
  }
}

}  // namespace haptex::kes
