// Buttons, hooks and elastic bands, springs between two places of a cloth, and drawstrings through
// several, all of which open under load.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "haptex/cloth/forces/force.h"

namespace haptex::cloth {

enum class FastenerKind { kButton, kHook, kElastic, kDrawstring };

constexpr const char* nameOf(FastenerKind kind) {
  switch (kind) {
    case FastenerKind::kButton:
      return "button";
    case FastenerKind::kHook:
      return "hook";
    case FastenerKind::kElastic:
      return "elastic";
    default:
      return "drawstring";
  }
}

/// A particle, or a place in a triangle: the weighted sum of up to three particles.
struct ClothPlace {
  std::array<int, 3> particles = {-1, -1, -1};
  std::array<double, 3> weights = {1.0, 0.0, 0.0};  ///< sum 1; particles of weight 0 are not read
};

/// Places of a cloth that a spring holds together until it is pulled too hard.
struct Fastener {
  std::string name;
  FastenerKind kind = FastenerKind::kButton;
  /// Two; a drawstring runs through 2 to Fasteners::kMostPlaces in this order, and is closed if the
  /// last is the first.
  std::vector<ClothPlace> places;
  double stiffness = 0.0;      ///< N/m, > 0
  double length = 0.0;         ///< m, >= 0, up to which it is slack; 0 of buttons and hooks
  double release_force = 0.0;  ///< N, > 0, the most that it carries
  bool fastened = true;        ///< of a cloth that no step has opened anything of
};

/// Fasteners pull their places towards each other and never push them apart. At the distance r of
/// the places, or along all those of a drawstring, which slides through them without friction, the
/// tension (N) is
///   0                       for r <= length,
///   stiffness (r - length)  up to release_force, and
///   release_force           beyond,
/// because none carries more than what it opens at. So the energy is convex in r, which is convex
/// in the positions, the tension is continuous, and no step, however long, pulls harder than the
/// fastener holds once Newton iterations have converged. What is beyond release_force at the end of
/// an accepted step is open from then on (remember()): what the spring held then is lost, and no
/// other force changes, so that neither energy nor momentum is made.
///
/// Where two places of a drawstring meet, the direction of its pull would jump: its distances d are
/// sqrt(d^2 + kRounding^2), as if it went around something there.
///
/// Whether each is fastened is in the memory of the state, two numbers each: 1 or 0, and the
/// tension (N) at which it opened by itself, else 0. All pairs of their particles are in the
/// matrix's pattern, fastened or not, so that opening and fastening change no pattern and allocate
/// nothing.
///
/// Layers that collide lie a thickness apart. A fastener is slack up to there, so that it does not
/// press them together for ever.
class Fasteners final : public Force {
 public:
  static constexpr std::size_t kMostPlaces = 32;
  static constexpr double kRounding = 1e-4;  ///< m

  /// @param particles of the cloth
  /// @param thickness m, >= 0: no fastener is shorter, a drawstring by so much between all places
  /// @throws std::invalid_argument naming fastener, value and what is allowed: a name that another
  ///   has, another number of places, a particle that does not exist, weights that are not finite
  ///   or do not sum to 1 within 1e-6, two places in a row that are the same, a stiffness, length
  ///   or release force out of its range
  Fasteners(std::vector<Fastener> fasteners, std::size_t particles, double thickness);

  /// As they were given.
  const std::vector<Fastener>& all() const { return fasteners_; }
  /// m, up to which a fastener is slack: its length, or the thickness.
  double slackLength(std::size_t fastener) const { return links_[fastener].length; }
  /// m, beyond which it opens.
  double reach(std::size_t fastener) const;
  /// m, of its places, along all of them.
  double distance(std::size_t fastener, const Positions& positions) const;
  /// N, that it has at these positions if it is fastened.
  double tension(std::size_t fastener, const Positions& positions) const;
  /// @throws std::invalid_argument naming the fastener if its places are beyond reach(), with their
  ///   distance and what is allowed
  void requireWithinReach(std::size_t fastener, const Positions& positions) const;

  /// @param memory of this force
  static bool isFastened(std::size_t fastener, const double* memory);
  /// N, at which it opened by itself; 0 if it did not since it was fastened or unfastened.
  static double openedAt(std::size_t fastener, const double* memory);
  static void set(std::size_t fastener, bool fastened, double* memory);

  std::vector<std::array<int, 2>> pairs() const override;
  void bind(const linear::SymmetricBlockMatrix& matrix) override;
  std::size_t memorySize() const override { return 2 * links_.size(); }
  std::vector<std::vector<int>> memoryOwners() const override;
  /// Each is as Fastener::fastened says.
  void forget(const Positions& positions, double* memory) const override;
  /// Opens what is pulled beyond its release force.
  void remember(const Positions& positions, double* memory) const override;

  void addForces(const ForceState& state, std::vector<Eigen::Vector3d>& forces) const override;
  double energy(const ForceState& state) const override;
  void addJacobian(const ForceState& state, JacobianRows& rows) const override;
  /// With the exact Jacobian, which is negative semidefinite: tension >= 0, and its slope by r,
  /// too.
  void assembleLinearised(const ForceState& state, const StageTimes& times,
                          linear::SymmetricBlockMatrix& matrix,
                          linear::BlockVector& rhs) const override;

 private:
  /// A fastener in the particles that it acts on. A segment, from a place to the next one, acts by
  /// its extent: the sum of weights times positions, the second place less the first one.
  struct Link {
    std::vector<int> particles;  // ascending
    Eigen::MatrixXd weights;     // in a segment (row) of a particle (column)
    std::vector<int> slots;      // of pairs (1, 0), (2, 0), (2, 1), (3, 0), ...
    double length = 0.0;         // m
    double rounding = 0.0;       // m
  };
  /// A vector for every segment.
  using Segments = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, kMostPlaces>;
  /// At some positions.
  struct Course {
    double distance = 0.0;  // m, of all segments
    Segments directions;    // n: derivative of a segment's distance by its extent, no unit
    std::array<double, kMostPlaces> curvatures;  // 1/m, the 1 / r of (1 - n n^T) / r, likewise
  };
  /// By the extents, of a fastened one at some positions.
  struct Response {
    double tension;                                        // N
    double slope;                                          // N/m, of the tension by the distance
    std::array<Eigen::Matrix3d, kMostPlaces> stiffnesses;  // N/m, of a segment at one tension
  };

  static Link linkOf(const Fastener& fastener, std::size_t particles, double thickness);
  static Eigen::Vector3d extent(const Link& link, int segment,
                                const std::vector<Eigen::Vector3d>& vectors);
  static Course courseOf(const Link& link, const Positions& positions);
  static Segments pullRates(const Link& link, const Course& course, const Response& response,
                            const std::vector<Eigen::Vector3d>& velocities);
  template <typename Take>
  static void forEachBlock(const Link& link, const Course& course, const Response& response,
                           const Take& take);
  double tensionAt(std::size_t fastener, double distance) const;
  Response respond(std::size_t fastener, const Course& course) const;

  std::vector<Fastener> fasteners_;
  std::vector<Link> links_;  // likewise
};

}  // namespace haptex::cloth
