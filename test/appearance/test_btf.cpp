#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "../refusal.h"
#include "fixtures.h"
#include "haptex/appearance/btf.h"
#include "haptex/appearance/btf_measures.h"

namespace haptex::appearance::test_btf {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

TEST(Btf, OfAFlatFabricIsItsReflectance) {
  const material::Look look{{0.2, 0.4, 0.6}, {0.5, 0.3, 0.1}, 0.3, 0.4};
  const Btf btf = smallBtf(flatRelief(), look);
  const Reflectance reflectance(look);
  const Vector3d view = Vector3d(0.3, 0.4, 0.6).normalized(), light(0.0, -0.6, 0.8);
  const Vector3d seen = btf.pair(view, light).at({4e-4, 7e-4});
  EXPECT_LT((seen - 0.8 * reflectance.of(true, Vector3d::UnitZ(), light, view)).norm(), 1e-7);
}

TEST(Btf, IsDarkWhereCrestsKeepTheSunOff) {
  const Btf btf = smallBtf(furrows(), lookOf(0.0, 0.0, 0.0, 1.0));
  const Btf grey = smallBtf(furrows(), lookOf(0.5, 0.5, 0.0, 1.0));
  const Vector3d above = Vector3d::UnitZ(), across = Vector3d(1.0, 0.0, 0.2).normalized();
  const Vector2d crest(0.1e-3, 0.0), bottom(8e-4, 0.0);
  EXPECT_EQ(btf.pair(above, above).at(crest), Vector3d::Zero());  // of black
  EXPECT_GT(grey.pair(above, across).at(crest).x(), 0.02);
  // What there is in the shadow comes from lit slopes.
  const double shadow = grey.pair(above, across).at(bottom).x();
  EXPECT_GT(shadow, 0.0);
  EXPECT_LT(shadow, 0.3 * grey.pair(above, across).at(crest).x());
}

TEST(Btf, HidesWhatLiesBehindCrests) {
  // From the side only the flanks towards the eye are seen. Lit from behind it they are dark.
  const Btf btf = smallBtf(furrows(), lookOf(0.5, 0.5, 0.0, 1.0));
  const Vector3d eye = Vector3d(1.0, 0.0, 0.3).normalized();
  const Vector3d behind = Vector3d(-1.0, 0.0, 0.3).normalized();
  const auto places = placesOver(btf.surface().size(), 16, 1);
  EXPECT_LT(meanRadiance(btf.pair(eye, behind), places).x(),
            0.3 * meanRadiance(btf.pair(eye, eye), places).x());
}

TEST(Btf, OfWhiteYarnsSendsBackAllOfAnEvenSky) {
  const MeasureSize size{6, 1, 48, 4, 2};
  EXPECT_LT(
      furnaceError(makeBtf(furrows(4e-4), lookOf(1.0, 1.0, 0.0, 1.0), {64, 64, kSmall}), size),
      0.01);
  // Texels here are as coarse as a fifth of a yarn; a relief of 256 is within 1 %, see the app.
  EXPECT_LT(furnaceError(makeBtf(twill(), lookOf(1.0, 1.0, 0.15, 0.4), {96, 96, kSmall}), size),
            0.02);
}

TEST(Btf, OfGreyYarnsDoesNot) {
  EXPECT_GT(furnaceError(smallBtf(furrows(4e-4), lookOf(0.97, 0.97, 0.0, 1.0)), {6, 1, 48, 4, 2}),
            0.02);
}

TEST(Btf, IsTheSameWithEyeAndLightExchanged) {
  const MeasureSize size{64, 12, 1, 1, 3};
  EXPECT_LT(reciprocityError(makeBtf(twill(), lookOf(0.6, 0.3, 0.2, 0.3), {96, 96, kSmall}), size),
            0.02);
}

TEST(Btf, BetweenSampledDirectionsIsWhatRaysSay) {
  const tactile::FaceRelief relief = twill();
  const material::Look look = lookOf(0.6, 0.3, 0.1, 0.5);
  const Btf btf = makeBtf(relief, look, {64, 64, {32, 1, 32}});
  const Interreflection exact(ReliefSurface(relief, 64, 64), look);
  const MeasureSize size{16, 16, 1, 1, 4};
  EXPECT_LT(unsampledError(btf, exact, size).of_mean, 0.02);
  // The light between texels is worth being stored: without it the error is larger.
  CompressedRows nothing = btf.indirect();
  nothing.mean.setZero();
  nothing.basis.setZero();
  EXPECT_GT(unsampledError(Btf(btf.surface(), look, nothing), exact, size).of_mean, 0.05);
}

TEST(Btf, RefusesWhatIsStoredForAnotherRelief) {
  const Btf btf = smallBtf(flatRelief(), lookOf(0.5, 0.5, 0.0, 1.0));
  const std::string refusal = test::refusalOf([&] {
    Btf(ReliefSurface(flatRelief(), 16, 16), lookOf(0.5, 0.5, 0.0, 1.0), btf.indirect());
  });
  EXPECT_NE(refusal.find("for 1024 texels"), std::string::npos) << refusal;
  EXPECT_THROW(btf.pair({0.0, 0.0, -1.0}, {0.0, 0.0, 1.0}), std::invalid_argument);
}

}  // namespace
}  // namespace haptex::appearance::test_btf
