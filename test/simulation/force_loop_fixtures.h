// A force loop with a wool sample in a frame and a hand whose index can touch it.
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <utility>

#include "haptex/material/fabric_file.h"
#include "haptex/simulation/force_loop.h"

namespace haptex::simulation {

class TouchedSheet {
 public:
  using Finger = base::Finger;
  using Time = base::Time;

  static constexpr double kRadius = 0.0075;         // m
  static constexpr double kTouch = kRadius - 5e-3;  // m
  static constexpr int kCells = 8;
  static constexpr double kSize = 0.1;  // m; in the plane x = 0, its top edge at z = 0

  TouchedSheet() : loop_(base::PerFinger<double>{{kRadius, kRadius}}) {
    mesh_ = mesh::makeRectangle(kSize, kSize, kCells, kCells, mesh::Triangulation::kAlternating);
    state_.positions = mesh_.initial_positions;
    state_.velocities.assign(state_.positions.size(), Eigen::Vector3d::Zero());
    state_.attached.assign(state_.positions.size(), 0);
    for (const mesh::Side side :
         {mesh::Side::kBottom, mesh::Side::kTop, mesh::Side::kLeft, mesh::Side::kRight}) {
      for (const int particle : mesh::sideParticles(mesh_, side)) state_.attached[particle] = 1;
    }
    place(Finger::kIndex, 0.05);
    place(Finger::kThumb, 0.05);
    loop_.receiveHandBase(hand_, now_, now_, true);
  }

  ForceLoop& loop() { return loop_; }
  LargeScaleState& state() { return state_; }
  Time now() const { return now_; }

  static material::Fabric wool() {
    return material::loadFabric(std::string(HAPTEX_SOURCE_DIRECTORY) + "/config/fabrics/wool.yaml");
  }

  /// A layer with a patch of all triangles.
  void giveLayer() {
    contact::HapticSettings settings;
    settings.refinement = 1;
    auto layer =
        std::make_unique<contact::HapticLayer>(mesh_, wool(), cloth::ModelledEffects(), settings);
    std::vector<int> triangles(mesh_.triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) triangles[i] = static_cast<int>(i);
    auto update = std::make_unique<LayerUpdate>();
    update->patch = layer->preparePatch(triangles, state_.attached);
    update->layer = std::move(layer);
    update->particles = state_.positions.size();
    update->replaces_layer = update->replaces_patch = true;
    loop_.offer(std::move(update));
    loop_.setLayerReady(true);
  }

  /// Puts the centre of a fingertip before the middle of the sheet, in the world frame.
  /// @param x m, from the sheet
  void place(Finger finger, double x) {
    poses_[finger] = hand_.inverse() * Eigen::Translation3d(x, 0.0, -0.5 * kSize);
  }
  /// Presses the index 5 mm deep into the sheet within 100 ms. Its centre stays before the sheet.
  void touch() {
    for (int i = 0; i <= 100; ++i) {
      place(Finger::kIndex, kTouch + (1.0 - 0.01 * i) * 6e-3);
      tick();
    }
  }

  void silence(RendererSource source, bool silent = true) {
    silent_[static_cast<std::size_t>(source)] = silent;
  }

  void tick() {
    using namespace std::chrono_literals;
    now_ += 1ms;
    ++ticks_;
    const auto lives = [&](RendererSource source) {
      return !silent_[static_cast<std::size_t>(source)];
    };
    if (lives(RendererSource::kHeartbeat) && ticks_ % 5 == 0) loop_.receiveHeartbeat(now_);
    if (lives(RendererSource::kClothState) && ticks_ % 12 == 0) {
      state_.simulated_time += 0.012;
      loop_.receiveState(state_, now_);
    }
    if (lives(RendererSource::kProximity)) {
      loop_.reportAnswer(true);
    } else {
      loop_.reportAnswer(false);
    }
    for (const Finger finger : base::kFingers) {
      if (finger == Finger::kIndex && !lives(RendererSource::kFingertip)) continue;
      loop_.receivePose(finger, poses_[finger], now_);
      loop_.receiveTwist(finger, FingertipTwist(), now_);
    }
    loop_.tick(now_);
  }
  void run(int milliseconds) {
    for (int i = 0; i < milliseconds; ++i) tick();
  }

  /// N, in the world frame, as rendered.
  Eigen::Vector3d force(Finger finger = Finger::kIndex) const {
    const ForceLoop::Rendered& rendered = loop_.rendered(finger);
    return rendered.gain * rendered.contact.force;
  }

 private:
  Time now_ = std::chrono::seconds(10);
  int ticks_ = 0;
  ForceLoop loop_;
  mesh::ClothMesh mesh_;
  LargeScaleState state_;
  Eigen::Isometry3d hand_ =
      Eigen::Translation3d(0.3, -0.2, 0.1) * Eigen::AngleAxisd(1.1, Eigen::Vector3d::UnitZ());
  base::PerFinger<Eigen::Isometry3d> poses_;
  std::array<bool, kRendererSourceCount> silent_{};
};

}  // namespace haptex::simulation
