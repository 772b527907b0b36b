// Strict reading of YAML files: every refusal names file, key, value and what is allowed. Nothing
// of a file that is of another kind is told: the path may be anybody's request.
#pragma once

#include <yaml-cpp/yaml.h>

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <string>
#include <vector>

namespace haptex::base {

/// What a YAML file may have at most: bytes, values (an alias counted as what it stands for) and
/// levels of nesting. The largest that ships has 67 kB, about 6000 values and 6 levels.
constexpr std::size_t kLargestYaml = std::size_t{256} << 10;
constexpr std::size_t kMostYamlValues = 100'000;
constexpr std::size_t kDeepestYaml = 32;

/// For files that may be larger than most.
struct YamlLimits {
  std::size_t bytes = kLargestYaml;
  std::size_t values = kMostYamlValues;
};

/// @param largest bytes that are read at most
/// @throws std::runtime_error naming the path if it cannot be read or is larger
std::string readTextFile(const std::string& path, std::size_t largest = kLargestYaml);

/// A value in a YAML file together with the path of keys that leads to it, for example
/// "warp.elastic.points[3]". All member functions throw std::invalid_argument with a message of the
/// form "<file>: <key path>: <value> <what is allowed>" if the value is not as asked for.
class YamlValue {
 public:
  /// The top-level value of a file with exactly one YAML document.
  /// @throws std::runtime_error naming the path, and line and kind of a syntax error, if the file
  ///   cannot be read, is not YAML or is larger than the limits above; then it is not held
  static YamlValue load(const std::string& path);
  /// The same of a text.
  /// @param name of it in messages, instead of a path
  static YamlValue parse(const std::string& text, const std::string& name,
                         const YamlLimits& limits = {});

  const std::string& file() const { return *file_; }
  const std::string& keyPath() const { return key_path_; }

  bool isMap() const { return node_.IsMap(); }
  bool isList() const { return node_.IsSequence(); }

  /// Refuses anything but a map with all the required keys and no others than the optional ones,
  /// each once. Of a whole file that has none of them no key is named. Call it before at() and
  /// has().
  void requireKeys(const std::vector<std::string>& required,
                   const std::vector<std::string>& optional = {}) const;
  bool has(const std::string& key) const;
  YamlValue at(const std::string& key) const;

  /// The items of a list.
  std::vector<YamlValue> items() const;
  /// The items of a list of exactly `size`.
  std::vector<YamlValue> items(std::size_t size) const;

  /// A finite number.
  double number() const;
  int integer() const;
  /// A text that is not empty or blank.
  std::string text() const;
  /// One of the given words.
  std::string oneOf(const std::vector<const char*>& words) const;

  /// Throws the refusal of this value: "<file>: <key path>: <value> <reason>".
  [[noreturn]] void refuse(const std::string& reason) const;
  /// The same without the value, for a reason that states it.
  [[noreturn]] void refuseBecause(const std::string& reason) const;

 private:
  YamlValue(std::shared_ptr<const std::string> file, std::string key_path, const YAML::Node& node);

  /// Refuses a map that has keys but none of these.
  void requireKind(const std::vector<std::string>& keys) const;
  std::string describeValue() const;

  std::shared_ptr<const std::string> file_;
  std::string key_path_;
  YAML::Node node_;
};

}  // namespace haptex::base
