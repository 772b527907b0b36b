// Garments that are worn over each other, as one pattern.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "../refusal.h"
#include "garment_fixtures.h"
#include "haptex/garment/pattern/outfit.h"

namespace haptex::garment::test_outfit {
namespace {

class Outfit : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(directory_);
    write("shirt", kSmallGarment);
    write("trousers", kSmallGarment);
  }
  void TearDown() override { std::filesystem::remove_all(directory_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(directory_ + "/" + name + ".yaml") << text;
  }
  Pattern load(const std::string& garments) const {
    write("outfit", "source: made up\ngarments: " + garments + "\n");
    return loadOutfit(directory_ + "/outfit.yaml");
  }
  std::string refusal(const std::string& garments) const {
    return test::refusalOf([&] { load(garments); });
  }

  const std::string directory_ = testing::TempDir() + "outfit_" + std::to_string(getpid());
};

TEST_F(Outfit, HasAllPanelsCarriersAndSeamsEachUnderTheNameOfItsGarment) {
  const Pattern one = parsePattern(kSmallGarment, "small.yaml");
  const Pattern both = load("[trousers, shirt]");
  const std::size_t panels = one.panels.size(), seams = one.seams.size();
  ASSERT_EQ(both.panels.size(), 2 * panels);
  ASSERT_EQ(both.seams.size(), 2 * seams);
  EXPECT_EQ(both.panels[0].name, "trousers/" + one.panels[0].name);
  EXPECT_EQ(both.panels[panels].name, "shirt/" + one.panels[0].name);
  EXPECT_EQ(both.carriers[0].name, "trousers/torso");
  EXPECT_EQ(std::get<OnCarrier>(both.panels[panels + 1].placement).carrier, "shirt/torso");
  for (std::size_t s = 0; s < seams; ++s) {
    EXPECT_EQ(both.seams[seams + s].sides[0].panel,
              one.seams[s].sides[0].panel + static_cast<int>(panels));
  }
  ASSERT_EQ(both.fastenings.size(), 2u);
  EXPECT_EQ(both.fastenings[1].name, "shirt/button");
  EXPECT_EQ(both.fastenings[1].places[1].panel, 1 + static_cast<int>(panels));
}

TEST_F(Outfit, NamesOfPanelsAreThoseThatGroupsOfObjFilesCanHave) {
  std::string text = kSmallGarment;
  const auto rename = [&](const std::string& name, const std::string& other) {
    for (std::size_t at = 0; (at = text.find(name, at)) != text.npos; at += other.size()) {
      text.replace(at, name.size(), other);
    }
    write("shirt", text);
  };
  rename("front", "the panel");
  EXPECT_EQ(loadOutfit(directory_ + "/shirt.yaml").panels[0].name, "the_panel");
  EXPECT_EQ(load("[shirt]").panels[0].name, "shirt/the_panel");
  rename("back", "the_panel");
  EXPECT_NE(refusal("[shirt]").find("panel 'shirt/the_panel' is there twice"), std::string::npos);
}

TEST_F(Outfit, LayersFollowTheOrderOfDressingAlone) {
  const std::size_t panels = parsePattern(kSmallGarment, "small.yaml").panels.size();
  for (const char* order : {"[trousers, shirt]", "[shirt, trousers]"}) {
    const Pattern both = load(order);
    int highest = 0, lowest = kLargestLayer;
    for (std::size_t p = 0; p < panels; ++p) {
      highest = std::max(highest, both.panels[p].layer);
      lowest = std::min(lowest, both.panels[panels + p].layer);
    }
    EXPECT_GT(lowest, highest) << order;
  }
  EXPECT_EQ(load("[shirt, trousers]").panels[0].name.substr(0, 6), "shirt/");
}

TEST_F(Outfit, IsRefusedWithWhatIsWrong) {
  const auto expect = [&](const std::string& garments, const char* part) {
    const std::string message = refusal(garments);
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  expect("[]", "garments: has 0 garments: allowed are 1 to 8");
  expect("[shirt, trousers, ./shirt.yaml]", "is there twice");
  write("list", "source: made up\ngarments: [shirt]\n");
  expect("[list]", "list.yaml");
  EXPECT_THROW(load("[hat]"), std::runtime_error);
  std::string many = "[shirt, trousers";
  for (int i = 0; i < 7; ++i) {
    write("g" + std::to_string(i), kSmallGarment);
    many += ", g" + std::to_string(i);
  }
  expect(many + "]", "has 9 garments");
}

}  // namespace
}  // namespace haptex::garment::test_outfit
