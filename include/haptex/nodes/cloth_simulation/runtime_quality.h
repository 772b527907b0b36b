// The qualities that a simulated cloth may run by, and what is known about them.
#pragma once

#include <haptex/ClothQuality.h>
#include <haptex/QualityPoint.h>
#include <haptex/QueryBudget.h>
#include <ros/node_handle.h>
#include <ros/time.h>

#include <string>
#include <vector>

#include "haptex/material/fabric.h"
#include "haptex/scene/scene.h"
#include "haptex/simulation/quality_choice.h"
#include "haptex/simulation/simulated_cloth.h"
#include "haptex/simulation/studied_fabrics.h"

namespace haptex::nodes {

/// What a person asks for: a quality, a budget to choose a quality for, or a quality that may be
/// reduced for a budget.
struct QualityRequest {
  std::string preset_path;  ///< ~quality: of a file with one for the fabric; empty: none
  double budget = 0.0;      ///< ~budget_ms: s of computing time per cycle; 0: none
  bool of_scene = false;    ///< ~quality is kOfScene: the scene's own cells and settings

  static constexpr char kOfScene[] = "scene";

  bool any() const { return !preset_path.empty() || budget > 0.0; }
  bool reducible() const { return budget > 0.0 && (of_scene || !preset_path.empty()); }

  /// @throws std::invalid_argument naming the parameter, its value and what is allowed
  static QualityRequest read(const ros::NodeHandle& private_node);
};

/// Made at the start of a node: measures on this machine what the points of the front take for the
/// scene's cloth, and chooses. For a quality that may be reduced it measures no more than that one
/// and the cheapest of the front.
class RuntimeQuality {
 public:
  // The constructor measures for as long as that, and the time of two measurements.
  static constexpr double kAllowance = 1.5;          ///< s, for the front
  static constexpr double kBorrowedAllowance = 0.5;  ///< s, for borrowedSettings()
  /// Of a cycle, the longest budget of a quality that may be reduced: the rest is for messages.
  static constexpr double kMaxShare = 0.8;

  /// @param request with any()
  /// @throws std::exception naming what was wrong with a file
  RuntimeQuality(const std::string& scene_path, const QualityRequest& request);

  /// With the cells that were chosen.
  const scene::Scene& scene() const { return scene_; }

  /// Can take its steps by everything that it may switch to, and has a controller.
  simulation::SimulatedCloth simulate() const { return simulate(scene_, fabrics_); }
  /// The same for another mesh and other fabrics. Nothing is measured anew: what a cycle takes
  /// grows with the triangles at first, and then it is the load that tells.
  simulation::SimulatedCloth simulate(const scene::Scene& scene,
                                      std::vector<material::Fabric> fabrics) const;
  /// From now on the simulation is that of this scene.
  void setScene(const scene::Scene& scene);

  /// @param simulation of simulate(); here and below
  haptex::ClothQuality message(const simulation::SimulatedCloth& simulation,
                               const ros::Time& stamp) const;

  /// Runs by the named quality and stays with it, or, without a name, chooses among them for a
  /// budget.
  /// @param budget s per cycle, finite and >= 0; 0: none, and the finest stays. By a thread that
  /// may
  ///   change the simulation
  /// @returns what was done
  /// @throws std::invalid_argument naming quality or budget and what is allowed
  std::string set(simulation::SimulatedCloth& simulation, const std::string& name, double budget);

  /// Whether less runs than the quality that was asked for, for the sake of the budget.
  bool reduced(const haptex::ClothQuality& message) const;
  const std::string& wanted() const { return rungs_.back().quality.name; }

  /// Fills in all but success. @param budget s @returns the message
  /// @throws std::invalid_argument naming the budget unless it is finite and > 0
  std::string query(const simulation::SimulatedCloth& simulation, double budget,
                    haptex::QueryBudget::Response& response) const;

 private:
  /// Learns the fabrics of their measurements.
  void study(const std::vector<scene::Quality>& qualities);
  void choose(const std::string& scene_path);
  void reduce(const std::string& scene_path, const scene::Quality& wanted);
  scene::Quality qualityOfScene() const;
  std::size_t rungOf(const std::string& name) const;
  std::vector<simulation::Candidate> borrowed(const std::string& scene_path,
                                              std::size_t chosen) const;
  haptex::QualityPoint pointMessage(const simulation::Candidate& candidate,
                                    const material::Fabric& fabric) const;

  scene::Scene scene_;
  std::vector<material::Fabric> fabrics_;  // of the scene
  double budget_;                          // s, infinity: none
  bool reducible_;                         // the last of rungs_ is what was asked for
  std::vector<simulation::Candidate>
      candidates_;                            // the front, from the cheapest to the most accurate
  std::vector<simulation::Candidate> rungs_;  // what a running cloth switches among
  std::size_t first_ = 0;                     // of rungs_, for a cloth that begins
  double cell_size_ = 0.0;  // m, of its cells, which the mesh has if it may have any
  std::vector<simulation::StudiedFabric> studied_;
};

}  // namespace haptex::nodes
