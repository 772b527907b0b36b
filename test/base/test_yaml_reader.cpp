// What YamlValue tells, and does not tell, of files.
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "../refusal.h"
#include "haptex/base/quoted.h"
#include "haptex/base/yaml_reader.h"

namespace haptex::base::test_yaml_reader {
namespace {

const std::vector<std::string> kKeys = {"name", "size"};

std::string refusal(const std::string& text, const std::string& name = "file") {
  return test::refusalOf<std::exception>([&] {
    const YamlValue file = YamlValue::parse(text, name);
    file.requireKeys(kKeys);
    file.at("name").text();
    file.at("size").number();
  });
}

TEST(YamlReader, AcceptsWhatIsAsAskedFor) {
  EXPECT_EQ(refusal("name: wool\nsize: 2"), test::kNotRefused);
}

TEST(YamlReader, RefusesAPasswordFileWithoutItsContent) {
  EXPECT_EQ(refusal("root:x:0:0:root:/root:/bin/bash\ndaemon:x:1:1:daemon:/usr/sbin:/bin/sh\n"),
            "file: a text of 69 characters must be a map with the keys name, size");
}

TEST(YamlReader, RefusesAMapOfAnotherKindWithoutItsKeys) {
  EXPECT_EQ(refusal("token: secret\nuser: me\n"), "file: has none of the keys name, size");
}

TEST(YamlReader, RefusesAnEmptyMapForTheKeyThatIsMissing) {
  EXPECT_EQ(refusal("{}"), "file: the key 'name' is missing, required here: name, size");
}

TEST(YamlReader, NamesAnUnknownKeyBesideKnownOnes) {
  EXPECT_EQ(refusal("name: wool\nsise: 2"), "file: sise: unknown key, allowed here: name, size");
}

TEST(YamlReader, SyntaxErrorsAreToldByLineAndKindOnly) {
  EXPECT_EQ(refusal("name: wool\nsize: *secret"),
            "file: line 2: is not YAML: the referenced anchor is not defined");
  EXPECT_EQ(refusal("name: \"\\secret\""), "file: line 1: is not YAML: unknown escape character");
  EXPECT_EQ(refusal("name: [secret"), "file: line 1: is not YAML: end of sequence flow not found");
}

TEST(YamlReader, RefusedValuesAndKeysAreCut) {
  const std::string begin(kLongestQuote, 'a'), text(5000, 'a');
  EXPECT_EQ(refusal("name: wool\nsize: " + text),
            "file: size: '" + begin + "'... (5000 characters) must be a finite number");
  EXPECT_EQ(refusal("name: wool\n? " + text + "\n: 1"),
            "file: " + begin + "... (5000 characters): unknown key, allowed here: name, size");
}

TEST(YamlReader, TheNameOfTheFileIsCut) {
  const std::string begin(kLongestQuote, 'f'), name(5000, 'f');
  EXPECT_EQ(refusal("[", name).rfind(begin + "... (5000 characters): line 1: is not YAML", 0), 0u);
  EXPECT_EQ(refusal("[]", name).rfind(begin + "... (5000 characters): a list of 0 must", 0), 0u);
}

}  // namespace
}  // namespace haptex::base::test_yaml_reader
