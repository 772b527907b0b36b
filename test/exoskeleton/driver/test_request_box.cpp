#include <gtest/gtest.h>

#include <thread>

#include "haptex/exoskeleton/driver/request_box.h"
#include "haptex/realtime/steady_clock.h"

namespace haptex::exoskeleton::test_request_box {
namespace {

using namespace std::chrono_literals;

TEST(RequestBox, HasNothingToTakeUntilAsked) {
  exoskeleton::RequestBox box;
  exoskeleton::DriverRequest request{};
  EXPECT_FALSE(box.take(request));
}

TEST(RequestBox, WithdrawsARequestThatTheLoopDoesNotTake) {
  exoskeleton::RequestBox box;
  EXPECT_NE(box.ask(exoskeleton::DriverRequest::kEnable).find("has not answered within 0.5 s"),
            std::string::npos);
  exoskeleton::DriverRequest request{};
  EXPECT_FALSE(box.take(request));  // nobody waits for it any more
}

TEST(RequestBox, BringsBackTheAnswer) {
  exoskeleton::RequestBox box;
  for (const char* refusal : {"", "the device is not homed", ""}) {
    std::thread loop([&] {
      exoskeleton::DriverRequest request{};
      while (!box.take(request)) std::this_thread::yield();
      EXPECT_EQ(request, exoskeleton::DriverRequest::kHome);
      box.answer(refusal);
    });
    EXPECT_EQ(box.ask(exoskeleton::DriverRequest::kHome), refusal);
    loop.join();
  }
}

TEST(RequestBox, WaitsForALoopThatIsAtIt) {
  exoskeleton::RequestBox box;
  std::thread loop([&] {
    exoskeleton::DriverRequest request{};
    while (!box.take(request)) std::this_thread::yield();
    std::this_thread::sleep_for(exoskeleton::RequestBox::kPatience + 100ms);  // a very busy machine
    box.answer("late");
  });
  EXPECT_EQ(box.ask(exoskeleton::DriverRequest::kHome), "late");
  loop.join();
}

}  // namespace
}  // namespace haptex::exoskeleton::test_request_box
