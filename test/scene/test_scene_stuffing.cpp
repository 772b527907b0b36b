// The stuffing of a scene's cloth.
#include "scene_fixtures.h"

namespace haptex::scene::test_scene_stuffing {
namespace {

TEST(ShippedCushion, IsOfTwoSquaresThatEncloseEnoughForTheirStuffing) {
  const Scene scene = loadScene((kConfig / "scenes" / "cushion.yaml").string());
  EXPECT_EQ(scene.mesh.panelCount(), 2);
  EXPECT_EQ(scene.mesh.triangles.size(), 1024u);
  ASSERT_TRUE(scene.effects.stuffing);
  EXPECT_EQ(scene.effects.stuffing->volume, 0.02);
  EXPECT_EQ(scene.effects.stuffing->modulus, 50.0);
  const double volume = cloth::enclosedVolume(scene.mesh.triangles, scene.mesh.initial_positions);
  EXPECT_GT(volume, cloth::Stuffing::kLeastStart * scene.effects.stuffing->volume);
}

TEST_F(SceneFile, SaysWhatIsStuffedOnlyIfItListsIt) {
  const std::string key = "stuffing: {volume: 0.01, modulus: 50}\n";
  const auto listing = [](const std::string& model) {
    return replaced(kValid, "[gravity, viscosity]", model);
  };
  const auto expect = [&](const std::string& text, const std::string& part) {
    const std::string message = refusalOf(text);
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  EXPECT_EQ(load(listing("[self_collision, stuffing]") + key).effects.stuffing->volume, 0.01);
  EXPECT_FALSE(load(kValid).effects.stuffing);
  expect(kValid + key, "stuffing: is allowed only if model lists stuffing");
  expect(listing("[self_collision, stuffing]"), "lists stuffing, so the key stuffing is required");
  expect(listing("[stuffing]") + key, "lists stuffing, which needs self_collision listed, too");
  expect(listing("[self_collision, stuffing, fingers]") + key, "allowed is one of both");
  expect(listing("[self_collision, stuffing]") + "stuffing: {volume: 0, modulus: 50}\n",
         "stuffing.volume: '0' must be greater than 0");
  expect(listing("[self_collision, stuffing]") + "stuffing: {volume: 0.01, modulus: .inf}\n",
         "stuffing.modulus");
  expect(listing("[self_collision, stuffing]") + "stuffing: {volume: 0.01}\n", "modulus");
}

}  // namespace
}  // namespace haptex::scene::test_scene_stuffing
