#include <gtest/gtest.h>

#include <string>

#include "haptex/material/fabric_file.h"
#include "haptex/nodes/tactile_renderer/surface_choice.h"

namespace haptex::nodes::test_surface_choice {
namespace {

const std::string kFabrics = std::string(HAPTEX_SOURCE_DIRECTORY) + "/config/fabrics/";
const std::string kWool = kFabrics + "wool.yaml";      // has a surface
const std::string kLinear = kFabrics + "linear.yaml";  // has none

haptex::ClothMesh worn(const std::string& fabric) {
  haptex::ClothMesh message;
  message.fabrics = {fabric};
  message.fabric_files = {material::loadFabric(kFabrics + fabric + ".yaml").file};
  return message;
}

std::string refusal(SurfaceChoice& choice, const std::string& fabric) {
  try {
    choice.ask(fabric);
    return "";
  } catch (const std::exception& error) {
    return error.what();
  }
}

TEST(SurfaceChoice, BeginsWithTheScenesFabric) {
  const SurfaceChoice choice(kWool);
  ASSERT_NE(choice.surface(), nullptr);
  EXPECT_GT(choice.surface()->small_scale.waves.size(), 0u);
  EXPECT_EQ(choice.fabric(), "wool");
  EXPECT_EQ(choice.path(), kWool);
  EXPECT_EQ(choice.trouble(), "");
  ASSERT_TRUE(choice.values());
  EXPECT_GT(choice.values()->roughness, 0.0);
}

TEST(SurfaceChoice, FollowsTheFabricOfTheCloth) {
  SurfaceChoice choice(kWool);
  EXPECT_FALSE(choice.receiveCloth(worn("wool")));
  EXPECT_TRUE(choice.receiveCloth(worn("denim")));
  ASSERT_NE(choice.surface(), nullptr);
  EXPECT_EQ(choice.fabric(), "denim");
}

TEST(SurfaceChoice, WithoutASceneTakesThatOfTheFirstCloth) {
  SurfaceChoice choice("");
  EXPECT_EQ(choice.surface(), nullptr);
  EXPECT_NE(choice.trouble().find("cloth/mesh"), std::string::npos);
  EXPECT_TRUE(choice.receiveCloth(worn("wool")));
  EXPECT_NE(choice.surface(), nullptr);
  EXPECT_EQ(choice.trouble(), "");
}

TEST(SurfaceChoice, NamesTheKeyThatAFabricLacks) {
  const SurfaceChoice choice(kLinear);
  EXPECT_EQ(choice.surface(), nullptr);
  EXPECT_FALSE(choice.values());
  EXPECT_NE(choice.trouble().find("linear.yaml needs the key surface"), std::string::npos)
      << choice.trouble();
}

TEST(SurfaceChoice, HasNoneForAClothThatCannotBeStroked) {
  haptex::ClothMesh another = worn("wool");
  another.fabrics = {"linear"};
  haptex::ClothMesh broken = worn("wool");
  broken.fabric_files = {"wool.yaml"};
  for (const haptex::ClothMesh& message : {worn("linear"), another, broken}) {
    SurfaceChoice choice(kWool);
    EXPECT_TRUE(choice.receiveCloth(message));
    EXPECT_EQ(choice.surface(), nullptr) << choice.fabric();
    EXPECT_NE(choice.trouble().find("'" + message.fabrics[0] + "'"), std::string::npos)
        << choice.trouble();
  }
}

TEST(SurfaceChoice, HasOneForEveryFabricOfTheCloth) {
  haptex::ClothMesh hemmed = worn("wool");
  for (const char* name : {"denim", "linear"}) {
    hemmed.fabrics.push_back(name);
    hemmed.fabric_files.push_back(worn(name).fabric_files[0]);
  }
  SurfaceChoice choice(kWool);
  EXPECT_TRUE(choice.receiveCloth(hemmed)) << "regions are new";
  EXPECT_EQ(choice.fabric(), "wool, denim, linear");
  ASSERT_NE(choice.surface(0), nullptr);
  ASSERT_NE(choice.surface(1), nullptr);
  EXPECT_EQ(choice.surface(0)->fabric, "wool");
  EXPECT_EQ(choice.surface(1)->fabric, "denim");
  EXPECT_EQ(choice.surface(2), nullptr) << "linear has no surface";
  EXPECT_EQ(choice.surface(3), nullptr);
  EXPECT_NE(choice.trouble().find("'linear'"), std::string::npos);
  choice.ask("linen");
  EXPECT_EQ(choice.surface(2)->fabric, "linen") << "what was asked for is felt everywhere";
}

TEST(SurfaceChoice, KeepsWhatWasAskedForUntilTheClothChanges) {
  SurfaceChoice choice(kWool);
  choice.ask("denim");
  EXPECT_EQ(choice.fabric(), "denim");
  EXPECT_FALSE(choice.receiveCloth(worn("wool"))) << "it is the cloth's fabric as before";
  EXPECT_EQ(choice.fabric(), "denim");
  EXPECT_TRUE(choice.receiveCloth(worn("linen")));
  EXPECT_EQ(choice.fabric(), "linen");
  choice.ask(kWool);
  EXPECT_EQ(choice.path(), kWool);
}

TEST(SurfaceChoice, RefusesWhatCannotBeStrokedAndKeepsTheSurface) {
  SurfaceChoice choice(kWool);
  const tactile::Surface* before = choice.surface();
  EXPECT_NE(refusal(choice, "linear").find("needs the key surface"), std::string::npos);
  EXPECT_NE(refusal(choice, "velvet").find("'velvet'"), std::string::npos);
  EXPECT_NE(refusal(choice, "/no/such.yaml").find("/no/such.yaml"), std::string::npos);
  EXPECT_NE(refusal(choice, "").find("''"), std::string::npos);
  EXPECT_EQ(choice.surface(), before);
  EXPECT_EQ(choice.fabric(), "wool");
  EXPECT_EQ(choice.trouble(), "");
}

TEST(SurfaceChoice, RefusesABrokenFabricAtTheStart) {
  EXPECT_THROW(SurfaceChoice("/no/such.yaml"), std::exception);
}

}  // namespace
}  // namespace haptex::nodes::test_surface_choice
