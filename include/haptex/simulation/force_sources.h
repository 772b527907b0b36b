// User-defined forces on particles, from those who send them to the loop that steps the cloth.
#pragma once

#include <Eigen/Core>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "haptex/simulation/simulated_cloth.h"

namespace haptex::simulation {

/// What one source asks for.
struct ParticleForces {
  std::vector<std::uint32_t> particles;  ///< each once
  std::vector<Eigen::Vector3d> forces;   ///< N, world frame, one per particle
  double lifetime = 0.0;                 ///< s of simulated time
};

/// Keeps the newest forces of every source for their lifetime, and sets their sum on the cloth.
/// What the sources send may come from any thread; what is costly of it is done before the lock.
class ForceSources {
 public:
  static constexpr std::size_t kMax = 16;         ///< that act, or wait for the next step, at once
  static constexpr double kMaxForce = 1000.0;     ///< N, per axis
  static constexpr double kMaxLifetime = 3600.0;  ///< s

  /// @param particle_count of the cloth
  explicit ForceSources(std::size_t particle_count) : particle_count_(particle_count) {}

  /// Replaces the forces of a source. Without particles or with lifetime 0 they end.
  /// @throws std::invalid_argument naming what is wrong: the source is empty, forces and particles
  ///   differ in number, a particle does not exist or is named twice, a number is not finite or
  ///   beyond the bounds above, or kMax other sources act; nothing has changed then
  void set(const std::string& source, ParticleForces forces);

  // The functions below are for the thread that steps the cloth.

  /// Before every step. Forces act from the first call on, in whole steps of the scene: as many as
  /// are nearest to the lifetime, but at least one. Who repeats the same forces lengthens their
  /// time and does not wake a cloth that sleeps under them. Takes no lock as long as there are no
  /// forces, and allocates nothing.
  /// @param simulation the same one until clearFor()
  void apply(SimulatedCloth& simulation);

  /// Ends all forces, those that wait included. The simulation's stay: SimulatedCloth::reset() ends
  /// them.
  void clear();
  /// The same, and from now on they are for another cloth.
  /// @param particle_count of it
  void clearFor(std::size_t particle_count);

  std::size_t size() const;  ///< sources that act or wait; by any thread

 private:
  struct Slot {
    std::string source;
    bool waits = false;  // next has not been taken
    bool acts = false;   // acting is on the cloth
    ParticleForces next;
    ParticleForces acting;
    double end = 0.0;  // s, simulated, of what acts

    bool isFree() const { return !waits && !acts; }
    bool isOver(double time, double step) const { return acts && time > end - 0.5 * step; }
    bool changes(double time, double step) const;  // other forces act from now on
    void advance(double time, double step);
  };

  Slot* find(const std::string& source);

  std::atomic<std::size_t> particle_count_;
  std::atomic<bool> any_{false};  // whether a slot is not free
  mutable std::mutex mutex_;      // guards the following
  std::array<Slot, kMax> slots_;
  std::vector<Eigen::Vector3d> sums_;  // N, per particle; of those that something acts on
};

}  // namespace haptex::simulation
