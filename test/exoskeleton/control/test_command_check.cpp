#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <functional>
#include <limits>
#include <random>
#include <string>

#include "haptex/exoskeleton/control/command_check.h"

namespace haptex::exoskeleton::test_command_check {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kHuge = std::numeric_limits<double>::max();

ForceCommand touch() {
  ForceCommand command;
  command.force = {0.0, 0.0, 1.6};
  command.position = {0.1, 0.0, -0.05};
  command.velocity = {0.0, 0.1, 0.0};
  command.stiffness = Vector3d(0.0, 300.0, 1300.0).asDiagonal();
  command.damping = Vector3d(0.0, 0.0, 4.0).asDiagonal();
  return command;
}

void expectFlaw(const ForceCommand& command, CommandFlaw flaw,
                std::initializer_list<const char*> says) {
  EXPECT_EQ(findFlaw(command), flaw);
  const std::string why = explainFlaw(command);
  for (const char* text : says) EXPECT_NE(why.find(text), std::string::npos) << why;
}

TEST(CommandCheck, TakesAPassiveTouchInEveryDirection) {
  EXPECT_EQ(findFlaw(ForceCommand()), CommandFlaw::kNone);
  EXPECT_EQ(findFlaw(touch()), CommandFlaw::kNone);
  EXPECT_EQ(explainFlaw(touch()), "");
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  for (int i = 0; i < 10000; ++i) {
    // One direction only, as of a flat wall: its two other eigenvalues are what rounding leaves.
    const auto any = [&] {
      return Vector3d(number(generator), number(generator), number(generator));
    };
    const Vector3d normal = any().normalized();
    const Matrix3d turn = Eigen::Quaterniond(Eigen::AngleAxisd(3.0, any().normalized())).matrix();
    ForceCommand command = touch();
    const double size = std::pow(10.0, 4.9 * number(generator));
    command.stiffness = turn * (size * normal * normal.transpose()) * turn.transpose();
    command.damping = 0.01 * command.stiffness;
    ASSERT_EQ(findFlaw(command), CommandFlaw::kNone) << command.stiffness;
  }
}

TEST(CommandCheck, TakesNumbersAtTheirBoundsAndNoneBeyond) {
  const auto expect_bound = [](double largest, const char* name, const char* unit,
                               const std::function<void(ForceCommand&, double)>& set) {
    ForceCommand command = touch();
    set(command, largest);
    EXPECT_EQ(findFlaw(command), CommandFlaw::kNone) << name;
    for (const double number : {1.001 * largest, 1e3 * largest, 1e200, 1e308, kHuge}) {
      set(command, number);
      expectFlaw(command, CommandFlaw::kTooLarge,
                 {name, "allowed are numbers of a norm up to", unit});
    }
  };
  expect_bound(1000.0, "force = ", " N", [](auto& c, double x) { c.force = {0.0, -x, 0.0}; });
  expect_bound(10.0, "position = ", " m", [](auto& c, double x) { c.position = {0.0, 0.0, x}; });
  expect_bound(100.0, "velocity = ", " m/s", [](auto& c, double x) { c.velocity = {x, 0.0, 0.0}; });
  expect_bound(1e5, "stiffness = ", " N/m", [](auto& c, double x) {
    c.stiffness = x * Matrix3d::Identity().row(1).transpose() * Matrix3d::Identity().row(1);
  });
  expect_bound(1e3, "damping = ", " N s/m", [](auto& c, double x) {
    c.damping.setZero();
    c.damping(2, 2) = x;
  });
  ForceCommand command = touch();
  command.force = {800.0, 800.0, 0.0};  // each component is allowed, their norm is not
  expectFlaw(command, CommandFlaw::kTooLarge, {"force = (800 800   0)", "1000 N"});
}

TEST(CommandCheck, RefusesWhatWouldGiveEnergy) {
  for (const bool stiffness : {true, false}) {
    const char* name = stiffness ? "stiffness = " : "damping = ";
    const auto with = [&](const Matrix3d& matrix) {
      ForceCommand command = touch();
      (stiffness ? command.stiffness : command.damping) = matrix;
      return command;
    };
    expectFlaw(with(Vector3d(500.0, -1.0, 0.0).asDiagonal()), CommandFlaw::kActive,
               {name, "has the eigenvalue -1", "allowed are symmetric positive semidefinite"});
    expectFlaw(with(-Matrix3d::Identity()), CommandFlaw::kActive, {name, "eigenvalue -1"});
    expectFlaw(with(-1e-300 * Matrix3d::Identity()), CommandFlaw::kActive, {name});
    Matrix3d sheared = Matrix3d::Identity();
    sheared(0, 1) = 0.1;  // work around a loop
    expectFlaw(with(sheared), CommandFlaw::kActive, {name, "differs from its transpose by 0.1"});
    Matrix3d coupled = Matrix3d::Zero();
    coupled(0, 1) = coupled(1, 0) = 100.0;
    expectFlaw(with(coupled), CommandFlaw::kActive, {name, "has the eigenvalue -100"});
  }
  ForceCommand command = touch();
  command.stiffness *= -1e6;
  expectFlaw(command, CommandFlaw::kTooLarge, {"stiffness = ", "up to 100000 N/m"});
}

TEST(CommandCheck, NamesTheFirstNumberThatIsNotFinite) {
  ForceCommand command = touch();
  command.damping(1, 1) = std::numeric_limits<double>::quiet_NaN();
  expectFlaw(command, CommandFlaw::kNotFinite, {"damping = ", "nan", "finite numbers"});
  command.force.x() = std::numeric_limits<double>::infinity();
  expectFlaw(command, CommandFlaw::kNotFinite, {"force = (inf", "finite numbers"});
}

}  // namespace
}  // namespace haptex::exoskeleton::test_command_check
