// Supplies the force loop with layers and patches, and the cloth with what acts on it.
#pragma once

#include <haptex/ClothMesh.h>
#include <haptex/ContactForces.h>
#include <haptex/QueryProximity.h>
#include <ros/ros.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "haptex/base/clock.h"
#include "haptex/contact/haptic_layer.h"
#include "haptex/contact/patch_selection.h"
#include "haptex/nodes/common/proximity_messages.h"
#include "haptex/nodes/force_renderer/layer_builder.h"
#include "haptex/simulation/force_loop.h"
#include "haptex/simulation/patch_supply.h"

namespace haptex::nodes {

struct PatchSupplierStatus {
  std::string trouble;         ///< why there is no layer; empty: there is one
  std::string query_trouble;   ///< why the last query failed; empty: it did not
  std::uint64_t queries = 0;   ///< answered since the start
  std::uint64_t failures = 0;  ///< queries that were not, since the start
  std::size_t triangles = 0;   ///< of the patch
  double query_seconds = 0.0;  ///< from question to answer, both fingers, of the last one
};

/// A thread of its own, which may wait for the proximity service: for every state of the cloth, and
/// every kAskPeriod at the latest, it asks which triangles are near the fingertips, over a
/// connection that stays open, prepares a patch when they change, and publishes what acts on the
/// cloth on cloth/contact_forces, once per state. It makes a new layer when mesh or fabric change.
class PatchSupplier {
 public:
  using Time = base::Time;
  static constexpr Time kAskPeriod = std::chrono::milliseconds(6);

  /// @param node in whose namespace topic and service are
  /// @param loop outlives this
  PatchSupplier(const ros::NodeHandle& node, LayerBuilder builder, simulation::ForceLoop& loop);
  /// As stop().
  ~PatchSupplier();
  PatchSupplier(const PatchSupplier&) = delete;
  PatchSupplier& operator=(const PatchSupplier&) = delete;

  /// Ends the thread.
  void stop();

  /// By any thread: mesh and fabric are these from now on. The same ones again change nothing.
  void setMesh(const haptex::ClothMeshConstPtr& message);
  /// By any thread: which particles are attached.
  void setAttached(const std::vector<char>& attached);

  PatchSupplierStatus status() const;

 private:
  using Query = haptex::QueryProximity;

  void run();
  void takeMesh();
  void buildLayer(const haptex::ClothMesh& message);
  void publishForces(const simulation::LoopView& view);
  void ask(const simulation::LoopView& view);
  bool askAbout(const contact::SearchVolume& volume, contact::PatchSelection& selection);
  void supplyPatch();
  void fail(const std::string& why);

  ros::NodeHandle node_;
  const LayerBuilder builder_;
  simulation::ForceLoop& loop_;
  ros::Publisher force_publisher_;

  // Of the thread.
  ros::ServiceClient client_;
  Time next_connection_{0};
  Time next_question_{0};
  RestMesh mesh_;
  haptex::ClothMeshConstPtr message_;              // of the layer
  const contact::HapticLayer* layer_ = nullptr;    // the loop's; null: none
  std::optional<simulation::PatchSupply> supply_;  // with the layer
  std::uint64_t loadings_published_ = 0;
  std::uint64_t states_asked_ = 0;
  bool published_forces_ = false;
  std::vector<cloth::PointLoad> loads_;
  haptex::ContactForces forces_;
  bool failed_ = true;

  mutable std::mutex mutex_;  // guards the next
  haptex::ClothMeshConstPtr incoming_mesh_;
  std::vector<char> attached_;
  PatchSupplierStatus status_;

  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace haptex::nodes
