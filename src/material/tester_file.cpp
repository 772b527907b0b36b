#include "haptex/material/tester_file.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "haptex/base/file_size.h"
#include "haptex/base/parse_number.h"
#include "haptex/base/quoted.h"
#include "haptex/base/require.h"
#include "haptex/material/kes_conditions.h"
#include "haptex/material/surface.h"

namespace haptex::material {
namespace {

constexpr const char* kHeader = "test,direction,branch,x,y";
constexpr double kAny = std::numeric_limits<double>::max();

/// A unit and how much of the SI unit (of degrees for angles) it is.
struct Unit {
  std::string name;
  double factor;
};

struct Range {
  double low, high;
  bool above_low = false;  ///< low itself is not allowed
};
constexpr Range kPositive{0.0, kAny, true};
constexpr Range kNotNegative{0.0, kAny};
constexpr Range kFinite{-kAny, kAny};

const std::vector<Unit> kNone = {{"1", 1.0}};
const std::vector<Unit> kRatios = {{"1", 1.0}, {"%", 0.01}};
const std::vector<Unit> kLengths = {{"m", 1.0}, {"mm", 1e-3}};
const std::vector<Unit> kForcesPerWidth = {{"N/m", 1.0}, {"gf/cm", kKesGramPerCentimetre}};
const std::vector<Unit> kWorks = {{"J/m2", 1.0}, {"gf.cm/cm2", kKesGramPerCentimetre}};
const std::vector<Unit> kMoments = {{"N", 1.0}, {"gf.cm/cm", 9.80665e-3}};

struct TestRule {
  TesterTest test;
  bool has_direction;
  std::vector<Unit> x_units, y_units;
  Range x, y;
};

const std::map<std::string, TestRule>& testRules() {
  static const std::map<std::string, TestRule> rules = {
      {"tensile",
       {TesterTest::kTensile,
        true,
        kRatios,
        {{"N/m", 1.0}, {"gf/cm", kKesGramPerCentimetre}, {"N", 1.0}},
        kNotNegative,
        kFinite}},
      {"shear",
       {TesterTest::kShear,
        true,
        {{"deg", 1.0}, {"rad", 180.0 / M_PI}},
        kForcesPerWidth,
        {-45.0, 45.0},
        kFinite}},
      {"bending",
       {TesterTest::kBending, true, {{"1/m", 1.0}, {"1/cm", 100.0}}, kMoments, kFinite, kFinite}},
      {"compression",
       {TesterTest::kCompression,
        false,
        kLengths,
        {{"Pa", 1.0}, {"kPa", 1e3}, {"gf/cm2", 98.0665}},
        kPositive,
        kNotNegative}},
      {"surface", {TesterTest::kSurface, false, kLengths, kNone, kFinite, kFinite}}};
  return rules;
}

struct ValueRule {
  bool has_direction;
  std::vector<Unit> units;
  Range range;
};

const std::map<std::string, ValueRule>& valueRules() {
  static const std::vector<Unit> shear_moduli = {
      {"N/m", 1.0}, {"gf/(cm.deg)", kKesGramPerCentimetre * 180.0 / M_PI}};
  static const std::vector<Unit> rigidities = {
      {"N.m", 1.0}, {"uN.m", 1e-6}, {"gf.cm2/cm", 9.80665e-5}};
  static const std::map<std::string, ValueRule> rules = {
      {"W", {false, {{"kg/m2", 1.0}, {"g/m2", 1e-3}, {"mg/cm2", 0.01}}, kPositive}},
      {"EMT", {true, kRatios, kPositive}},
      {"LT", {true, kNone, {0.3, 1.5}}},
      {"WT", {true, kWorks, kPositive}},
      {"RT", {true, kRatios, {TensileResilience::kLeast, 1.0}}},
      {"G", {true, shear_moduli, kNotNegative}},
      {"2HG", {true, kForcesPerWidth, kNotNegative}},
      {"2HG5", {true, kForcesPerWidth, kNotNegative}},
      {"B", {true, rigidities, kNotNegative}},
      {"2HB", {true, kMoments, kNotNegative}},
      {"LC", {false, kNone, kPositive}},
      {"WC", {false, kWorks, kPositive}},
      {"RC", {false, kRatios, {0.0, 1.0}}},
      {"T0", {false, kLengths, kPositive}},
      {"TM", {false, kLengths, kPositive}},
      {"MIU", {true, kNone, kPositive}},
      {"MMD", {true, kNone, {0.0, 1.0}}},
      {"SMD", {true, {{"m", 1.0}, {"um", 1e-6}}, {0.0, kMaxRoughness, true}}},
      {"E5", {true, kRatios, kPositive}},
      {"E20", {true, kRatios, kPositive}},
      {"E100", {true, kRatios, kPositive}},
      {"EB5", {false, kRatios, kPositive}},
      {"C", {true, kLengths, kPositive}},
      {"T2", {false, kLengths, kPositive}},
      {"T100", {false, kLengths, kPositive}}};
  return rules;
}

std::string trimmed(const std::string& text) {
  const char* const kBlank = " \t\r";
  const std::size_t begin = text.find_first_not_of(kBlank);
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find_last_not_of(kBlank) - begin + 1);
}

std::vector<std::string> wordsOf(const std::string& text, char separator) {
  std::vector<std::string> words;
  std::istringstream stream(text);
  for (std::string word; std::getline(stream, word, separator);) {
    word = trimmed(word);
    if (separator == ',' || !word.empty()) words.push_back(word);
  }
  if (separator == ',' && !text.empty() && text.back() == ',') words.emplace_back();
  return words;
}

template <typename Rules>
std::string keysOf(const Rules& rules) {
  std::string keys;
  for (const auto& [key, rule] : rules) keys += (keys.empty() ? "" : ", ") + key;
  return keys;
}

std::string namesOf(const std::vector<Unit>& units) {
  std::string names;
  for (const Unit& unit : units) names += (names.empty() ? "" : ", ") + unit.name;
  return names;
}

std::string textOf(const Range& range) {
  const std::string low = base::shortNumber(range.low);
  if (range.low == -kAny) return "finite";
  if (range.high == kAny) return "finite and " + std::string(range.above_low ? "> " : ">= ") + low;
  return (range.above_low ? "greater than " : "from ") + low +
         (range.above_low ? " and at most " : " to ") + base::shortNumber(range.high);
}

/// How the numbers of a test become SI.
struct TestUnits {
  std::string x, y;
  double x_factor, y_factor;
  bool per_width;  ///< y still to be divided by the width
};

class Reader {
 public:
  explicit Reader(const std::string& path) { file_.path = path; }

  TesterFile read() {
    std::ifstream stream(file_.path);
    if (!stream) throw std::runtime_error(file_.path + ": cannot be read");
    base::requireFileSize(file_.path, kLargestTesterFile);
    bool header = false;
    for (std::string text; std::getline(stream, text);) {
      ++line_;
      if (line_ == 1 && text.rfind("\xef\xbb\xbf", 0) == 0) text.erase(0, 3);
      text = trimmed(text);
      if (text.empty()) continue;
      if (text.front() == '#') {
        readComment(trimmed(text.substr(1)));
      } else if (!header) {
        if (text != kHeader) refuse("must be the line of columns, ", kHeader);
        header = true;
      } else {
        readRow(wordsOf(text, ','));
      }
    }
    if (!header) refuse("the line of columns is missing, ", kHeader);
    for (const auto& [key, loop] : file_.readings) requireRising(key.first, loop.loading);
    return std::move(file_);
  }

 private:
  template <typename... Parts>
  [[noreturn]] void refuse(const Parts&... parts) const {
    refuseAt(line_, parts...);
  }
  template <typename... Parts>
  [[noreturn]] void refuseAt(std::size_t line, const Parts&... parts) const {
    base::refuse(file_.path, ":", line, ": ", parts...);
  }

  template <typename Rules>
  const auto& ruleOf(const Rules& rules, const char* what, const std::string& key) const {
    const auto rule = rules.find(key);
    if (rule == rules.end()) {
      refuse(what, " ", base::quoted(key), " is unknown; allowed are ", keysOf(rules));
    }
    return rule->second;
  }

  double factorOf(const std::vector<Unit>& units, const std::string& name,
                  const std::string& of) const {
    for (const Unit& unit : units) {
      if (unit.name == name) return unit.factor;
    }
    refuse("unit ", base::quoted(name), " of ", of, " is unknown; allowed are ", namesOf(units));
  }

  /// In SI, checked there; a refusal has the number as written.
  double numberOf(const char* what, const std::string& text, double factor,
                  const Range& range) const {
    const std::optional<double> number = base::parseNumber<double>(text);
    if (!number) {
      refuse(what, " ", base::quoted(text), " must be a number with a point for decimals");
    }
    const double si = *number * factor;
    // In this order, so that NaN is refused.
    if (!(si >= range.low && si <= range.high) || (range.above_low && si == range.low)) {
      refuse(what, " is ", base::shortened(text),
             factor == 1.0 ? "" : ", in SI " + base::shortNumber(si), "; it must be ",
             textOf(range));
    }
    return si;
  }

  void readComment(const std::string& text) {
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos) return;
    const std::string key = text.substr(0, colon), rest = trimmed(text.substr(colon + 1));
    if (key == "source") {
      file_.source += (file_.source.empty() ? "" : " ") + rest;
    } else if (key == "provenance") {
      if (rest != "measured" && rest != "representative") {
        refuse("provenance ", base::quoted(rest),
               " is unknown; allowed are measured, representative");
      }
      file_.measured = rest == "measured";
    } else if (key == "units") {
      readUnits(wordsOf(rest, ' '));
    } else if (key == "width") {
      const std::vector<std::string> words = wordsOf(rest, ' ');
      if (words.size() != 2) refuse("width must be a number and a unit, as in: width: 50 mm");
      width_ = numberOf("width", words[0], factorOf(kLengths, words[1], "width"), kPositive);
    }
  }

  void readUnits(const std::vector<std::string>& words) {
    if (words.size() != 3) {
      refuse("units must be a test and the units of x and y, as in: units: tensile % gf/cm");
    }
    const TestRule& rule = ruleOf(testRules(), "test", words[0]);
    units_[words[0]] = {words[1], words[2], factorOf(rule.x_units, words[1], words[0] + "'s x"),
                        factorOf(rule.y_units, words[2], words[0] + "'s y"),
                        words[2] == "N" && rule.test == TesterTest::kTensile};
  }

  void readRow(const std::vector<std::string>& words) {
    if (words.size() != 5) {
      refuse("has ", words.size(), " columns, must have 5: ", kHeader);
    }
    if (words[1] != "weft" && words[1] != "warp" && !words[1].empty()) {
      refuse("direction ", base::quoted(words[1]),
             " is unknown; allowed are weft, warp, or nothing");
    }
    if (words[0] == "value") {
      readValue(words);
    } else {
      readReading(words);
    }
  }

  void requireDirection(bool allowed, const std::string& of, const std::string& direction) const {
    if (!allowed && !direction.empty()) {
      refuse(of, " has no direction; ", base::quoted(direction), " must be left out");
    }
  }

  void readReading(const std::vector<std::string>& words) {
    const std::string& name = words[0];
    if (testRules().count(name) == 0) {
      refuse("test ", base::quoted(name), " is unknown; allowed are ", keysOf(testRules()),
             ", value");
    }
    const TestRule& rule = testRules().at(name);
    requireDirection(rule.has_direction, name, words[1]);
    if (rule.has_direction && words[1].empty()) {
      refuse("the direction of ", name, " is missing; allowed are weft, warp");
    }
    if (words[2] != "loading" && words[2] != "unloading") {
      refuse("branch ", base::quoted(words[2]), " is unknown; allowed are loading, unloading");
    }
    const auto units = units_.find(name);
    if (units == units_.end()) {
      refuse("no units of ", name, " before this line; write '# units: ", name,
             " X Y' with X one of ", namesOf(rule.x_units), " and Y one of ",
             namesOf(rule.y_units));
    }
    const TestUnits& of = units->second;
    if (of.per_width && !width_) {
      refuse("no width before this line; with forces in N write, for example, '# width: 50 mm'");
    }
    const double x = numberOf("x", words[3], of.x_factor, rule.x);
    const double y = numberOf("y", words[4], of.per_width ? 1.0 / *width_ : of.y_factor, rule.y);
    ReadingLoop& loop = file_.readings[{rule.test, words[1]}];
    (words[2] == "loading" ? loop.loading : loop.unloading).push_back({x, y, line_});
  }

  void readValue(const std::vector<std::string>& words) {
    const ValueRule& rule = ruleOf(valueRules(), "value", words[2]);
    requireDirection(rule.has_direction, words[2], words[1]);
    const double factor = factorOf(rule.units, words[4], words[2]);
    const double value = numberOf(words[2].c_str(), words[3], factor, rule.range);
    const bool is_new = file_.values.insert({{words[2], words[1]}, value}).second;
    if (!is_new) refuse(words[2], " of the same direction is there twice; it must be there once");
  }

  /// The stress of a loading branch rises, but for noise. It starts anew with every specimen.
  void requireRising(TesterTest test, const std::vector<Reading>& loading) const {
    if (test == TesterTest::kBending || test == TesterTest::kSurface) return;
    const auto stress = [&](const Reading& r) {
      return test == TesterTest::kShear && r.x < 0.0 ? -r.y : r.y;
    };
    const auto progress = [&](const Reading& r) {
      return test == TesterTest::kCompression ? loading.front().x - r.x : std::abs(r.x);
    };
    double scale = 0.0;
    for (const Reading& reading : loading) scale = std::max(scale, std::abs(stress(reading)));
    double farthest = 0.0, largest = -kAny;
    for (const Reading& reading : loading) {
      if (progress(reading) < 0.5 * farthest) {
        farthest = 0.0;
        largest = -kAny;
      }
      farthest = std::max(farthest, progress(reading));
      if (stress(reading) < largest - TesterFile::kMostFall * scale) {
        refuseAt(reading.line, "the stress falls from ", base::shortNumber(largest), " to ",
                 base::shortNumber(stress(reading)),
                 " (SI) while the branch is loading; it may fall by at most 5 % of ",
                 base::shortNumber(scale), ": leave out what is torn or slips");
      }
      largest = std::max(largest, stress(reading));
    }
  }

  TesterFile file_;
  std::size_t line_ = 0;
  std::map<std::string, TestUnits> units_;
  std::optional<double> width_;  // m
};

}  // namespace

const ReadingLoop& TesterFile::loop(TesterTest test, const std::string& direction) const {
  static const ReadingLoop none;
  const auto found = readings.find({test, direction});
  return found == readings.end() ? none : found->second;
}

std::optional<double> TesterFile::value(const std::string& name,
                                        const std::string& direction) const {
  for (const std::string& of : {direction, std::string()}) {
    if (const auto found = values.find({name, of}); found != values.end()) return found->second;
  }
  const auto weft = values.find({name, "weft"}), warp = values.find({name, "warp"});
  if (!direction.empty() || weft == values.end() || warp == values.end()) return std::nullopt;
  return 0.5 * (weft->second + warp->second);
}

TesterFile readTesterFile(const std::string& path) { return Reader(path).read(); }

}  // namespace haptex::material
