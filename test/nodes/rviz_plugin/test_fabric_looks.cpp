#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <string>
#include <thread>

#include "../../appearance/fixtures.h"
#include "../../temporary_directory.h"
#include "haptex/appearance/btf_file.h"
#include "haptex/nodes/rviz_plugin/fabric_looks.h"

namespace haptex::nodes::test_fabric_looks {
namespace {

using appearance::flatRelief;
using appearance::lookOf;
using test::TemporaryDirectory;

std::string written(const std::string& path, double warp) {
  appearance::writeBtf(
      appearance::makeBtf(flatRelief(), lookOf(warp, warp, 0.0, 1.0), {16, 16, {4, 1, 4}}), path);
  return path;
}

/// As soon as its file was read.
FabricLooks::Look awaited(FabricLooks& looks, const std::string& path) {
  FabricLooks::Look look = looks.of(path);
  while (!look.brdf && look.error.empty()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    look = looks.of(path);
  }
  return look;
}

float seenFromAbove(const FabricLooks::Look& look) {
  return look.brdf->underSky({0.0, 0.0, 1.0}).x();
}

TEST(FabricLooks, AreThoseOfTheirFiles) {
  const TemporaryDirectory folder;
  const std::string grey = written(folder.path() + "/grey.btf", 0.3);
  const std::string light = written(folder.path() + "/light.btf", 0.8);
  FabricLooks looks;
  EXPECT_EQ(looks.of(grey).brdf, nullptr) << "it is not waited for";
  EXPECT_NEAR(seenFromAbove(awaited(looks, light)), 0.8F, 1e-4F);
  EXPECT_NEAR(seenFromAbove(awaited(looks, grey)), 0.3F, 1e-4F);
}

TEST(FabricLooks, SayWhatIsWrongWithAFileAndReadItAnewOnRequest) {
  const TemporaryDirectory folder;
  const std::string path = folder.path() + "/wool.btf";
  FabricLooks looks;
  EXPECT_NE(awaited(looks, path).error.find("wool.btf"), std::string::npos);
  std::ofstream(path) << "no function";
  EXPECT_NE(awaited(looks, path).error.find("cannot be read"), std::string::npos)
      << "known files are not read again";
  looks.forget();
  EXPECT_NE(awaited(looks, path).error.find("does not begin with"), std::string::npos);
  written(path, 0.5);
  looks.forget();
  EXPECT_NEAR(seenFromAbove(awaited(looks, path)), 0.5F, 1e-4F);
}

TEST(FabricLooks, EndWhileFilesAreOpen) {
  const TemporaryDirectory folder;
  const std::string path = written(folder.path() + "/wool.btf", 0.5);
  for (int i = 0; i < 5; ++i) {
    FabricLooks looks;
    looks.of(path);
    looks.of(folder.path() + "/silk.btf");
    if (i % 2 == 1) looks.forget();
  }
}

}  // namespace
}  // namespace haptex::nodes::test_fabric_looks
