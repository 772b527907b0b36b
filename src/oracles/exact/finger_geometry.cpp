#include "haptex/oracles/exact/finger_geometry.h"

#include <Eigen/Geometry>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace haptex::oracles {
namespace {

constexpr double kRadians = M_PI / 180.0;

}  // namespace

using base::Finger;
using Eigen::Vector3d;
using exoskeleton::JointVector;

Anthropometry anthropometry(Finger finger) {
  if (finger == Finger::kIndex) {
    return {{0.034, 0.022, -0.014}, Vector3d::Zero(), {0.0398, 0.0224, 0.0121}, 2.0 / 3.0, 0.0};
  }
  return {
      {-0.012, 0.038, -0.032}, {3.1, 1.0, -0.22}, {0.0462, 0.0316, 0.0184}, 1.0, -20.0 * kRadians};
}

Vector3d planarTip(const Anthropometry& finger, const JointVector& angles) {
  double bent = 0.0, along = 0.0, below = 0.0;
  for (int i = 0; i < 3; ++i) {
    bent += angles[i + 1];
    along += finger.lengths[i] * std::cos(bent);
    below += finger.lengths[i] * std::sin(bent);
  }
  return {along * std::cos(angles[0]), along * std::sin(angles[0]), -below};
}

Vector3d closedFormTip(const Anthropometry& finger, const JointVector& angles) {
  const Vector3d& turn = finger.roll_pitch_yaw;
  return finger.first_joint +
         Eigen::AngleAxisd(turn.z(), Vector3d::UnitZ()) *
             (Eigen::AngleAxisd(turn.y(), Vector3d::UnitY()) *
              (Eigen::AngleAxisd(turn.x(), Vector3d::UnitX()) * planarTip(finger, angles)));
}

std::string shippedUrdf(const std::string& config_directory) {
  const std::string path = config_directory + "/../urdf/hand_exoskeleton.urdf";
  std::ifstream file(path);
  if (!file) throw std::invalid_argument(path + ": cannot be read");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

}  // namespace haptex::oracles
