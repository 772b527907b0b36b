#include "haptex/base/yaml_reader.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "haptex/base/file_size.h"
#include "haptex/base/quoted.h"
#include "yaml_size.h"

namespace haptex::base {
namespace {

std::string join(const std::vector<std::string>& words) {
  std::string list;
  for (const std::string& word : words) list += (list.empty() ? "" : ", ") + word;
  return list;
}

bool contains(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// The kind of a syntax error. To some kinds yaml-cpp appends what stands in the file.
std::string kindOf(const YAML::Exception& error) {
  for (const char* const kind : {YAML::ErrorMsg::UNKNOWN_ANCHOR, YAML::ErrorMsg::INVALID_ESCAPE,
                                 YAML::ErrorMsg::INVALID_UNICODE}) {
    std::string begin = kind;
    if (error.msg.compare(0, begin.size(), begin) != 0) continue;
    begin.erase(begin.find_last_not_of(": ") + 1);
    return begin;
  }
  return error.msg;
}

std::string below(const std::string& key_path, const std::string& key) {
  return key_path.empty() ? shortened(key) : key_path + "." + shortened(key);
}

}  // namespace

std::string readTextFile(const std::string& path, std::size_t largest) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    throw std::runtime_error(shortened(path) + ": there is no such file");
  }
  if (std::filesystem::is_directory(path, error)) {
    throw std::runtime_error(shortened(path) + ": is a directory, not a file");
  }
  requireFileSize(path, largest);
  std::ifstream stream(path, std::ios::binary);
  std::string text, part(std::size_t{1} << 16, '\0');
  while (stream && text.size() <= largest) {  // of a pipe the size is not known
    stream.read(part.data(), static_cast<std::streamsize>(part.size()));
    text.append(part, 0, static_cast<std::size_t>(stream.gcount()));
  }
  if (!stream.is_open() || stream.bad()) {
    throw std::runtime_error(shortened(path) + ": cannot be read");
  }
  requireSize(path, text.size(), largest);
  return text;
}

YamlValue::YamlValue(std::shared_ptr<const std::string> file, std::string key_path,
                     const YAML::Node& node)
    : file_(std::move(file)), key_path_(std::move(key_path)), node_(node) {}

YamlValue YamlValue::load(const std::string& path) { return parse(readTextFile(path), path); }

YamlValue YamlValue::parse(const std::string& text, const std::string& name,
                           const YamlLimits& limits) {
  requireSize(name, text.size(), limits.bytes);
  std::vector<YAML::Node> documents;
  try {
    requireSmallYaml(text, limits.values);
    documents = YAML::LoadAll(text);
  } catch (const YAML::Exception& error) {
    throw std::runtime_error(shortened(name) + ": line " + std::to_string(error.mark.line + 1) +
                             ": is not YAML: " + kindOf(error));
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(shortened(name) + ": " + error.what());
  }
  if (documents.size() != 1) {
    throw std::runtime_error(shortened(name) + ": has " + std::to_string(documents.size()) +
                             " YAML documents, must have one");
  }
  return YamlValue(std::make_shared<const std::string>(name), "", documents.front());
}

void YamlValue::requireKeys(const std::vector<std::string>& required,
                            const std::vector<std::string>& optional) const {
  std::vector<std::string> allowed = required;
  allowed.insert(allowed.end(), optional.begin(), optional.end());
  if (!node_.IsMap()) refuse("must be a map with the keys " + join(allowed));
  if (key_path_.empty()) requireKind(allowed);
  std::vector<std::string> seen;
  for (const auto& entry : node_) {
    const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "(not a text)";
    const YamlValue value(file_, below(key_path_, key), entry.second);
    if (!contains(allowed, key)) value.refuseBecause("unknown key, allowed here: " + join(allowed));
    if (contains(seen, key)) value.refuseBecause("the key is given twice");
    seen.push_back(key);
  }
  for (const std::string& key : required) {
    if (!contains(seen, key)) {
      refuseBecause("the key '" + key + "' is missing, required here: " + join(required));
    }
  }
}

void YamlValue::requireKind(const std::vector<std::string>& keys) const {
  const bool has_known =
      node_.size() == 0 || std::any_of(node_.begin(), node_.end(), [&](const auto& entry) {
        return entry.first.IsScalar() && contains(keys, entry.first.Scalar());
      });
  if (!has_known) refuseBecause("has none of the keys " + join(keys));
}

bool YamlValue::has(const std::string& key) const { return node_[key].IsDefined(); }

YamlValue YamlValue::at(const std::string& key) const {
  return YamlValue(file_, below(key_path_, key), node_[key]);
}

std::vector<YamlValue> YamlValue::items() const {
  if (!node_.IsSequence()) refuse("must be a list");
  std::vector<YamlValue> items;
  for (const YAML::Node& node : node_) {
    items.push_back(YamlValue(file_, key_path_ + "[" + std::to_string(items.size()) + "]", node));
  }
  return items;
}

std::vector<YamlValue> YamlValue::items(std::size_t size) const {
  const std::string reason = "must be a list of " + std::to_string(size);
  if (!node_.IsSequence() || node_.size() != size) refuse(reason);
  return items();
}

// yaml-cpp marks a quoted scalar with the tag "!": '5' is a text, not a number.
double YamlValue::number() const {
  double number = 0.0;
  if (!node_.IsScalar() || node_.Tag() == "!" || !YAML::convert<double>::decode(node_, number) ||
      !std::isfinite(number)) {
    refuse("must be a finite number");
  }
  return number;
}

int YamlValue::integer() const {
  int number = 0;
  if (!node_.IsScalar() || node_.Tag() == "!" || !YAML::convert<int>::decode(node_, number)) {
    refuse("must be an integer");
  }
  return number;
}

std::string YamlValue::text() const {
  if (!node_.IsScalar() || node_.Scalar().find_first_not_of(" \t\r\n") == std::string::npos) {
    refuse("must be a text that is not empty");
  }
  return node_.Scalar();
}

std::string YamlValue::oneOf(const std::vector<const char*>& words) const {
  const std::vector<std::string> allowed(words.begin(), words.end());
  if (!node_.IsScalar() || !contains(allowed, node_.Scalar())) {
    refuse(allowed.size() == 1 ? "must be " + allowed.front() : "must be one of " + join(allowed));
  }
  return node_.Scalar();
}

std::string YamlValue::describeValue() const {
  if (node_.IsScalar() && key_path_.empty()) {
    return "a text of " + std::to_string(node_.Scalar().size()) + " characters";
  }
  if (node_.IsScalar()) return quoted(node_.Scalar());
  if (node_.IsMap()) return "a map";
  if (node_.IsSequence()) return "a list of " + std::to_string(node_.size());
  return "nothing";
}

void YamlValue::refuse(const std::string& reason) const {
  refuseBecause(describeValue() + " " + reason);
}

void YamlValue::refuseBecause(const std::string& reason) const {
  throw std::invalid_argument(shortened(*file_) + ": " +
                              (key_path_.empty() ? "" : key_path_ + ": ") + reason);
}

}  // namespace haptex::base
