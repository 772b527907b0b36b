// How much processor time does a car's soft top take that opens and closes?
#pragma once

#include <urdf_parser/urdf_parser.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>
#include <string>

#include "haptex/proximity/intersections.h"
#include "haptex/scene/scene.h"
#include "haptex/scene/scene_fabric.h"
#include "haptex/simulation/simulated_cloth.h"
#include "tab_lines.h"

namespace haptex::bench {

/// Of a link in that of the root, whose joints are all revolute and follow the joint `top`.
inline Eigen::Isometry3d poseOf(const urdf::ModelInterface& model, const std::string& link,
                                double angle) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (urdf::LinkConstSharedPtr at = model.getLink(link); at && at->parent_joint;
       at = model.getLink(at->parent_joint->parent_link_name)) {
    const urdf::Joint& joint = *at->parent_joint;
    const urdf::Vector3& origin = joint.parent_to_joint_origin_transform.position;
    const double share = joint.mimic ? joint.mimic->multiplier : 1.0;
    pose = Eigen::Translation3d(origin.x, origin.y, origin.z) *
           Eigen::AngleAxisd(share * angle,
                             Eigen::Vector3d(joint.axis.x, joint.axis.y, joint.axis.z)) *
           pose;
  }
  return pose;
}

/// 0 to 1 and back: a pause, the way there, a pause, and the way back, each by minimum jerk.
inline double shareOpen(double time, double pause, double duration) {
  const bool closes = time > 2.0 * pause + duration;
  const double begin = closes ? 2.0 * pause + duration : pause;
  const double s = std::clamp((time - begin) / duration, 0.0, 1.0);
  const double there = s * s * s * (10.0 + s * (-15.0 + 6.0 * s));
  return closes ? 1.0 - there : there;
}

/// Prints garment/soft_top/triangles, s_per_s, opened once and closed in 6 s each with a second
/// before each, and intersections, the pairs of triangles of all states.
inline void measureSoftTop() {
  constexpr double kPause = 1.0, kDuration = 6.0;  // s
  const std::string path = HAPTEX_CONFIG_DIRECTORY "/scenes/soft_top.yaml";
  const scene::Scene scene = scene::loadScene(path);
  const urdf::ModelInterfaceSharedPtr model =
      urdf::parseURDFFile(HAPTEX_CONFIG_DIRECTORY "/../urdf/soft_top.urdf");
  if (!model) throw std::runtime_error("soft_top.urdf cannot be read");
  const double open = model->getJoint("top")->limits->upper;
  simulation::SimulatedCloth cloth(scene, scene::loadSceneFabrics(path, scene));
  double seconds = 0.0, time = 0.0;
  std::size_t intersections = 0;
  while (time < 2.0 * (kPause + kDuration)) {
    time += scene.time_step;
    const double begin = processorSeconds();
    for (std::size_t i = 0; i < cloth.frames().size(); ++i) {
      const double angle = open * shareOpen(time, kPause, kDuration);
      cloth.moveFrame(i, poseOf(*model, cloth.frames().name(i), angle));
    }
    if (!cloth.step()) throw std::runtime_error("a step of the soft top was rejected");
    seconds += processorSeconds() - begin;
    intersections +=
        proximity::intersectingTriangles(cloth.state().positions, cloth.cloth().mesh().triangles)
            .size();
  }
  printLine("garment/soft_top/triangles", static_cast<double>(scene.mesh.triangles.size()), "1");
  printLine("garment/soft_top/s_per_s", seconds / time, "s/s");
  printLine("garment/soft_top/intersections", static_cast<double>(intersections), "1");
}

}  // namespace haptex::bench
