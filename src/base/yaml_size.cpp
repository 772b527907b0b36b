#include "yaml_size.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <cstddef>
#include <map>
#include <sstream>
#include <vector>

#include "haptex/base/require.h"
#include "haptex/base/yaml_reader.h"

namespace haptex::base {
namespace {

class CountedValues : public YAML::EventHandler {
 public:
  explicit CountedValues(std::size_t most) : most_(most) {}

  void OnDocumentStart(const YAML::Mark& /*mark*/) override { sizes_.clear(); }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { addScalar(mark, anchor); }
  void OnScalar(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                const std::string& /*value*/) override {
    addScalar(mark, anchor);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto size = sizes_.find(anchor);
    if (size == sizes_.end())
      refuse("line ", mark.line + 1, ": an alias within what it stands for");
    add(mark, size->second);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value /*style*/) override {
    open(mark, anchor);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value /*style*/) override {
    open(mark, anchor);
  }
  void OnMapEnd() override { close(); }

 private:
  struct Open {
    YAML::anchor_t anchor;
    std::size_t values_before;
  };

  void add(const YAML::Mark& mark, std::size_t count) {
    values_ += count;
    if (values_ > most_) {
      refuse("line ", mark.line + 1, ": more than ", most_,
             " values, an alias counted as what it stands for");
    }
  }

  void addScalar(const YAML::Mark& mark, YAML::anchor_t anchor) {
    add(mark, 1);
    if (anchor != 0) sizes_[anchor] = 1;
  }

  void open(const YAML::Mark& mark, YAML::anchor_t anchor) {
    if (open_.size() == kDeepestYaml) {
      refuse("line ", mark.line + 1, ": nested deeper than ", kDeepestYaml, " levels");
    }
    open_.push_back({anchor, values_});
    add(mark, 1);
  }

  void close() {
    if (open_.back().anchor != 0) {
      sizes_[open_.back().anchor] = values_ - open_.back().values_before;
    }
    open_.pop_back();
  }

  std::size_t most_;
  std::size_t values_ = 0;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, std::size_t> sizes_;  // in values, of what has an anchor and is complete
};

}  // namespace

void requireSmallYaml(const std::string& text, std::size_t most_values) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  CountedValues counted(most_values);
  while (parser.HandleNextDocument(counted)) {
  }
}

}  // namespace haptex::base
