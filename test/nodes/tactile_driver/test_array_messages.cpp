#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "../../refusal.h"
#include "haptex/nodes/tactile_driver/array_messages.h"
#include "haptex/nodes/tactile_renderer/tactile_messages.h"

namespace haptex::nodes::test_array_messages {
namespace {

using base::Finger;

haptex::Tactile message() {
  haptex::Tactile message = tactileMessage(Finger::kThumb);
  message.amplitudes_40[3] = 12.0;
  message.amplitudes_320[23] = 4.5;
  return message;
}

std::string refusal(const haptex::Tactile& message) {
  return test::refusalOf([&] { amplitudesIn(Finger::kThumb, message); });
}

TEST(ArrayMessages, MicrometresBecomeMetres) {
  const tactile::ArrayAmplitudes amplitudes = amplitudesIn(Finger::kThumb, message());
  EXPECT_DOUBLE_EQ(amplitudes[3][tactile::k40], 12e-6);
  EXPECT_DOUBLE_EQ(amplitudes[23][tactile::k320], 4.5e-6);
  EXPECT_EQ(amplitudes[0][tactile::k40], 0.0);
}

TEST(ArrayMessages, RefusesWhatNoAmplitudeCanBeByFieldAndContactor) {
  for (const double value : {std::nan(""), HUGE_VAL, -1e-9, 1000.001}) {
    haptex::Tactile wrong = message();
    wrong.amplitudes_320[7] = value;
    EXPECT_NE(refusal(wrong).find("amplitudes_320[7]"), std::string::npos) << value;
    EXPECT_NE(refusal(wrong).find("from 0 to 1000 um"), std::string::npos) << value;
  }
  haptex::Tactile other = message();
  other.header.frame_id = "index_tactile";
  EXPECT_NE(refusal(other).find("thumb_tactile"), std::string::npos);
  EXPECT_EQ(refusal(message()), test::kNotRefused);
}

}  // namespace
}  // namespace haptex::nodes::test_array_messages
