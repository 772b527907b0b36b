#include "haptex/nodes/rviz_plugin/panel_texts.h"

#include <algorithm>
#include <cstdio>

namespace haptex::nodes {
namespace {

std::string cut(const std::string& text) { return text.substr(0, kLongest); }

}  // namespace

std::string statusOfNamespace(const std::string& name, const std::string& space) {
  const std::size_t end = name.find(": ");
  if (end == std::string::npos) return "";
  std::string prefix = space.empty() || space.front() != '/' ? space : space.substr(1);
  if (!prefix.empty()) prefix += "/";
  const std::string node = name.substr(0, end);
  const bool inside = node.compare(0, prefix.size(), prefix) == 0 &&
                      node.find('/', prefix.size()) == std::string::npos;
  return inside ? name.substr(end + 2) : "";
}

Diagnosis diagnosisOf(const diagnostic_msgs::DiagnosticStatus& status, double stamp,
                      const std::string& sender) {
  using Status = diagnostic_msgs::DiagnosticStatus;
  Diagnosis diagnosis;
  diagnosis.level = status.level == Status::OK     ? Diagnosis::Level::kOk
                    : status.level == Status::WARN ? Diagnosis::Level::kWarn
                                                   : Diagnosis::Level::kError;
  diagnosis.stamp = stamp;
  diagnosis.message = cut(status.message);
  const std::string node = status.name.substr(0, status.name.find(": "));
  if (sender != "/" + node) diagnosis.replayed_by = cut(sender);
  for (const diagnostic_msgs::KeyValue& pair : status.values) {
    diagnosis.values[cut(pair.key)] = cut(pair.value);
  }
  return diagnosis;
}

std::string qualityText(const haptex::ClothQuality& quality) {
  const haptex::QualityPoint& point = quality.quality;
  char text[96];
  std::snprintf(text, sizeof(text), " in %u substeps, %.2f ms a step", point.substeps,
                quality.cycle_ms);
  std::string lines = cut(point.name) + ": " + cut(point.integrator) + text;
  const std::size_t motions =
      std::min({point.motion.size(), point.position_error.size(), point.force_error.size()});
  for (std::size_t i = 0; i < motions; ++i) {
    std::snprintf(text, sizeof(text), ": %.2g mm, %.2g N", 1e3 * point.position_error[i],
                  point.force_error[i]);
    lines += (i == 0 ? "\nerror to expect in " : ", in ") + cut(point.motion[i]) + text;
  }
  if (motions == 0) lines += "\nits errors were not measured";
  if (motions > 0 && !point.cells_as_measured) lines += ", but for its cells, which are others";
  return lines;
}

}  // namespace haptex::nodes
