#include <gtest/gtest.h>

#include <limits>

#include "haptex/nodes/exoskeleton_driver/servo_force_filter.h"

namespace haptex::nodes::test_servo_force_filter {
namespace {

using base::Time;
using namespace std::chrono_literals;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// ROS time and steady time, which go on together.
struct Clocks {
  ros::Time ros{1000, 0};
  Time steady{5s};

  void advance(Time by) {
    ros.fromNSec(ros.toNSec() + static_cast<std::uint64_t>(by.count()));
    steady += by;
  }
};

ros::Time before(const ros::Time& time, Time by) {
  return ros::Time().fromNSec(time.toNSec() - static_cast<std::uint64_t>(by.count()));
}

haptex::ServoForce messageAt(const ros::Time& stamp) {
  haptex::ServoForce message;
  message.header.stamp = stamp;
  message.header.frame_id = "hand_base";
  message.force.z = 3.0;
  return message;
}

class AServoForceFilter : public ::testing::Test {
 protected:
  bool accepts(const haptex::ServoForce& message) {
    return filter_.receive(message, clocks_.ros, clocks_.steady).has_value();
  }

  /// Drops the message for the flaw, counts it there only, and says each of the texts.
  void expectDropped(const haptex::ServoForce& message, ServoForceFlaw flaw,
                     std::initializer_list<const char*> says) {
    std::array<std::uint64_t, kServoForceFlaws.size()> counts{};
    for (const ServoForceFlaw each : kServoForceFlaws) {
      counts[static_cast<std::size_t>(each)] = filter_.dropped(each) + (each == flaw ? 1 : 0);
    }
    const std::uint64_t taken = filter_.accepted();
    EXPECT_FALSE(accepts(message));
    for (const ServoForceFlaw each : kServoForceFlaws) {
      EXPECT_EQ(filter_.dropped(each), counts[static_cast<std::size_t>(each)]) << name(each);
    }
    EXPECT_EQ(filter_.accepted(), taken);
    const std::string why = filter_.explain(message, clocks_.ros);
    for (const char* text : says) EXPECT_NE(why.find(text), std::string::npos) << why;
  }

  Clocks clocks_;
  ServoForceFilter filter_;
};

TEST_F(AServoForceFilter, TakesAllOfACommand) {
  haptex::ServoForce message = messageAt(clocks_.ros);
  message.force.x = 1.0;
  message.force.y = 2.0;
  message.position.x = 0.1;
  message.position.y = 0.2;
  message.position.z = 0.3;
  message.velocity.x = 0.01;
  message.velocity.y = 0.02;
  message.velocity.z = 0.03;
  for (std::size_t i = 0; i < 9; ++i) {
    // As symmetric as rounding leaves it, but every number another one.
    message.stiffness[i] = (i % 4 == 0 ? 1000.0 : 0.0) + 1e-4 * static_cast<double>(i);
    message.damping[i] = (i % 4 == 0 ? 100.0 : 0.0) + 1e-5 * static_cast<double>(i);
  }
  const auto command = filter_.receive(message, clocks_.ros, clocks_.steady);
  ASSERT_TRUE(command);
  EXPECT_EQ(command->force, Eigen::Vector3d(1.0, 2.0, 3.0));
  EXPECT_EQ(command->position, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(command->velocity, Eigen::Vector3d(0.01, 0.02, 0.03));
  const Eigen::RowVector3d stiffness(3e-4, 1000.0 + 4e-4, 5e-4), damping(6e-5, 7e-5, 100.0 + 8e-5);
  EXPECT_LT((command->stiffness.row(1) - stiffness).norm(), 1e-9);  // row-major
  EXPECT_LT((command->damping.row(2) - damping).norm(), 1e-9);
  EXPECT_EQ(filter_.accepted(), 1u);
}

TEST_F(AServoForceFilter, DropsNumbersBeyondTheirBounds) {
  haptex::ServoForce message = messageAt(clocks_.ros);
  message.force.y = 1e308;
  expectDropped(message, ServoForceFlaw::kTooLarge, {"force = ", "1e+308", "up to 1000 N"});
  message = messageAt(clocks_.ros);
  message.stiffness[4] = -1e6;
  expectDropped(message, ServoForceFlaw::kTooLarge, {"stiffness = ", "-1e+06", "up to 100000 N/m"});
  message = messageAt(clocks_.ros);
  message.damping[8] = 1e4;
  expectDropped(message, ServoForceFlaw::kTooLarge, {"damping = ", "10000", "up to 1000 N s/m"});
}

TEST_F(AServoForceFilter, DropsStiffnessAndDampingThatGiveEnergy) {
  haptex::ServoForce message = messageAt(clocks_.ros);
  message.stiffness = {-100.0, 0.0, 0.0, 0.0, 100.0, 0.0, 0.0, 0.0, 0.0};
  expectDropped(message, ServoForceFlaw::kActive,
                {"stiffness = ", "-100", "positive semidefinite"});
  message.stiffness = {100.0, 5.0, 0.0, 0.0, 100.0, 0.0, 0.0, 0.0, 0.0};
  expectDropped(message, ServoForceFlaw::kActive, {"stiffness = ", "differs from its transpose"});
  message = messageAt(clocks_.ros);
  message.damping[0] = -1.0;
  expectDropped(message, ServoForceFlaw::kActive, {"damping = ", "has the eigenvalue -1 N s/m"});
}

TEST_F(AServoForceFilter, DropsOtherFrames) {
  for (const char* frame : {"", "world", "/hand_base", "index_tip"}) {
    haptex::ServoForce message = messageAt(clocks_.ros);
    message.header.frame_id = frame;
    expectDropped(message, ServoForceFlaw::kFrame, {"header.frame_id = '", frame, "'hand_base'"});
  }
}

TEST_F(AServoForceFilter, DropsEveryNumberThatIsNotFinite) {
  for (const double number : {kNaN, kInfinity, -kInfinity}) {
    for (int i = 0; i < 27; ++i) {
      haptex::ServoForce message = messageAt(clocks_.ros);
      double* const vectors[] = {&message.force.x,    &message.force.y,    &message.force.z,
                                 &message.position.x, &message.position.y, &message.position.z,
                                 &message.velocity.x, &message.velocity.y, &message.velocity.z};
      const char* const names[] = {"force = ", "position = ", "velocity = "};
      if (i < 9) {
        *vectors[i] = number;
      } else {
        (i < 18 ? message.stiffness : message.damping)[i % 9] = number;
      }
      const char* name = i < 9 ? names[i / 3] : i < 18 ? "stiffness = " : "damping = ";
      expectDropped(message, ServoForceFlaw::kNotFinite, {name, "allowed are finite numbers"});
    }
  }
}

TEST_F(AServoForceFilter, DropsStampsThatAreTooOld) {
  EXPECT_TRUE(accepts(messageAt(before(clocks_.ros, 20ms))));
  expectDropped(messageAt(before(clocks_.ros, 20ms + 1ns)), ServoForceFlaw::kTooOld,
                {"ms before the driver's clock", "allowed are 20 ms"});
  expectDropped(messageAt(ros::Time()), ServoForceFlaw::kTooOld, {"before"});
}

TEST_F(AServoForceFilter, DropsStampsOfTheFuture) {
  EXPECT_TRUE(accepts(messageAt(before(clocks_.ros, -20ms))));
  expectDropped(messageAt(before(clocks_.ros, -20ms - 1ns)), ServoForceFlaw::kTooNew,
                {"ms after the driver's clock", "allowed are 20 ms"});
  // The last there is: the difference does not fit a ros::Duration.
  expectDropped(messageAt(ros::Time(0xffffffffu, 999999999u)), ServoForceFlaw::kTooNew, {"after"});
}

TEST_F(AServoForceFilter, ReadsStampsWithMoreThanASecondOfNanoseconds) {
  haptex::ServoForce message = messageAt(clocks_.ros);
  message.header.stamp.sec -= 1;  // as no ros::Time would be, but bytes can
  message.header.stamp.nsec += 1000000000u;
  EXPECT_TRUE(accepts(message));
  expectDropped(messageAt(clocks_.ros), ServoForceFlaw::kOrder, {});
}

TEST_F(AServoForceFilter, DropsStampsThatAreNotLater) {
  EXPECT_TRUE(accepts(messageAt(clocks_.ros)));
  clocks_.advance(1ms);
  expectDropped(messageAt(before(clocks_.ros, 1ms)), ServoForceFlaw::kOrder,
                {"not later", "by 0 ms", "allowed are later ones"});
  expectDropped(messageAt(before(clocks_.ros, 3ms)), ServoForceFlaw::kOrder, {"by 2 ms"});
  EXPECT_TRUE(accepts(messageAt(before(clocks_.ros, 1ms - 1ns))));
}

TEST_F(AServoForceFilter, ADroppedCommandDoesNotCountAsTheLast) {
  EXPECT_TRUE(accepts(messageAt(clocks_.ros)));
  haptex::ServoForce bad = messageAt(before(clocks_.ros, -10ms));
  bad.force.x = kNaN;
  EXPECT_FALSE(accepts(bad));
  clocks_.advance(1ms);
  EXPECT_TRUE(accepts(messageAt(clocks_.ros)));
}

TEST_F(AServoForceFilter, RecoversAfterAClockThatWasSetBack) {
  clocks_.ros = ros::Time(2000, 0);
  EXPECT_TRUE(accepts(messageAt(clocks_.ros)));
  clocks_.ros = ros::Time(1500, 0);  // the commander shares the clock
  Time silent{0};
  while (!accepts(messageAt(clocks_.ros))) {
    clocks_.advance(1ms);
    silent += 1ms;
    ASSERT_LE(silent, 200ms);
  }
  EXPECT_EQ(silent, ServoForceFilter::kForgetAfter + 1ms);
  EXPECT_EQ(filter_.dropped(ServoForceFlaw::kOrder), 101u);
}

}  // namespace
}  // namespace haptex::nodes::test_servo_force_filter
