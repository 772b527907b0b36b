#include "haptex/garment/placement/seam_placement.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "haptex/base/require.h"

namespace haptex::garment {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kPoints = 4;             // of a seam
constexpr int kAngles = 24;            // of the grid
constexpr int kHeights = 17;           // of the grid
constexpr double kLeastRadius = 1e-3;  // m
constexpr int kMostSteps = 60;
constexpr double kStep = 1e-5;       // m, of differences
constexpr double kConverged = 1e-6;  // m
constexpr double kSideways = 0.7;  // sine of a direction: at the side of a panel rather than above
constexpr double kOverlap = 0.5;   // rad, that panels may overlap by on the way
/// How much more the seams of a carrier's panels with each other count than those with others.
constexpr double kOnOneCarrier = 100.0;

/// A seam between two panels, by points as offsets from their middles or in their planes.
struct Pairing {
  std::array<int, 2> panels;
  std::array<std::vector<Vector2d>, 2> points;
  std::vector<double> sides;  // on which side of its panel the first point is: x of the outward
                              // direction as seen on the carrier
  double weight = 0.0;        // of a point, m
  bool together = false;      // on one carrier
};

class Placement {
 public:
  Placement(const Pattern& pattern, const std::vector<double>& gaps,
            std::vector<PanelToPlace>& panels)
      : pattern_(pattern), panels_(panels), placed_(panels.size(), false) {
    for (std::size_t i = 0; i < pattern.seams.size(); ++i) addSeam(pattern.seams[i], gaps[i]);
  }

  void run() {
    std::size_t left = panels_.size();
    for (std::size_t i = 0; i < panels_.size(); ++i) {
      PanelToPlace& panel = panels_[i];
      if (!panel.pose && !panel.placed && !(panel.angle && panel.height)) continue;
      if (panel.angle) panel.place.angle = *panel.angle;
      if (panel.height) panel.place.height = *panel.height;
      placed_[i] = true;
      --left;
    }
    for (; left > 0; --left) placeOnGrid(mostSewn());
    collectUnknowns();
    minimise();
  }

 private:
  void addSeam(const Seam& seam, double gap) {
    const int first = seam.sides[0].panel, second = seam.sides[1].panel;
    if (first == second) return;
    const bool together = carrierOf(first) == carrierOf(second) && !carrierOf(first).empty();
    const double weight = (together ? kOnOneCarrier : 1.0) * lengthOf(pattern_, seam.sides[0]);
    Pairing pairing{{first, second}, {}, {}, weight / kPoints, together};
    for (const SeamPoint& point : seamPoints(pattern_, seam, kPoints)) {
      pairing.sides.push_back(panels_[first].view.directionOf(point.outward[0]).x());
      for (int side = 0; side < 2; ++side) {
        const PanelToPlace& panel = panels_[pairing.panels[side]];
        const Vector2d apart = point.points[side] + 0.5 * gap * point.outward[side];
        pairing.points[side].push_back(panel.pose ? apart : panel.view.offsetOf(apart));
      }
    }
    pairings_.push_back(std::move(pairing));
  }

  std::string carrierOf(int panel) const {
    const auto* on = std::get_if<OnCarrier>(&pattern_.panels[panel].placement);
    return on == nullptr ? "" : on->carrier;
  }

  Vector3d pointOf(int panel, const Vector2d& point) const {
    const PanelToPlace& of = panels_[panel];
    if (of.pose) return *of.pose * Vector3d(point.x(), point.y(), 0.0);
    return lay(of.surface, of.place, point);
  }

  /// From a seam's point on one side to that on the other; on one carrier around it, as the
  /// straight way would be the shorter for panels that overlap.
  Vector3d apart(const Pairing& pairing, int point) const {
    const auto [a, b] = pairing.panels;
    const Vector2d &first = pairing.points[0][point], &second = pairing.points[1][point];
    if (!pairing.together) return pointOf(a, first) - pointOf(b, second);
    const PlaceOnSurface &from = panels_[b].place, &to = panels_[a].place;
    const double radius = panels_[a].radius;
    double turn = std::remainder(to.angle - from.angle + (first - second).x() / radius, 2.0 * M_PI);
    // Edges at the sides are apart outwards, if need be by more than half a turn.
    const double side = pairing.sides[point];
    if (side > kSideways && turn > kOverlap) turn -= 2.0 * M_PI;
    if (side < -kSideways && turn < -kOverlap) turn += 2.0 * M_PI;
    return {radius * turn, to.height - from.height + (first - second).y(), 0.0};
  }

  /// The panel without a place that has the longest seams with those that have one.
  int mostSewn() const {
    std::vector<double> sewn(panels_.size(), 0.0);
    for (const Pairing& pairing : pairings_) {
      const auto [a, b] = pairing.panels;
      if (placed_[a] != placed_[b]) sewn[placed_[a] ? b : a] += pairing.weight;
    }
    const auto most = std::max_element(sewn.begin(), sewn.end());
    if (*most > 0.0) return static_cast<int>(most - sewn.begin());
    const auto lost = std::find(placed_.begin(), placed_.end(), false) - placed_.begin();
    base::refuse("panel '", pattern_.panels[lost].name,
                 "': where it lies is not known: it, or one that it is sewn to, must have a "
                 "position, or an angle and how far it lies along its carrier");
  }

  double costOf(int panel) const {
    double cost = 0.0;
    for (const Pairing& pairing : pairings_) {
      const auto [a, b] = pairing.panels;
      if ((a != panel || !placed_[b]) && (b != panel || !placed_[a])) continue;
      for (int i = 0; i < kPoints; ++i) cost += pairing.weight * apart(pairing, i).squaredNorm();
    }
    return cost;
  }

  void placeOnGrid(int index) {
    PanelToPlace& panel = panels_[index];
    PlaceOnSurface best = panel.place;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < (panel.height ? 1 : kHeights); ++i) {
      const double share = i / (kHeights - 1.0);
      const double height =
          panel.least_height + share * (panel.largest_height - panel.least_height);
      panel.place.height = panel.height.value_or(height);
      for (int j = 0; j < (panel.angle ? 1 : kAngles); ++j) {
        panel.place.angle = panel.angle.value_or(2.0 * M_PI * j / kAngles);
        if (panel.surface.radiusAt(panel.place.height) < kLeastRadius) continue;
        const double cost = costOf(index);
        if (cost >= least) continue;
        least = cost;
        best = panel.place;
      }
    }
    panel.place = best;
    panel.placed = placed_[index] = true;
  }

  void collectUnknowns() {
    unknowns_of_.resize(panels_.size());
    for (std::size_t i = 0; i < panels_.size(); ++i) {
      PanelToPlace& panel = panels_[i];
      if (panel.pose) continue;
      if (!panel.angle) addUnknown(i, panel.place.angle, panel.radius);
      if (!panel.height) addUnknown(i, panel.place.height, 1.0);
    }
  }

  void addUnknown(std::size_t panel, double& value, double metres) {
    unknowns_of_[panel].push_back(static_cast<Eigen::Index>(unknowns_.size()));
    unknowns_.push_back({&value, metres});
  }

  double cost() const {
    double sum = 0.0;
    for (const Pairing& pairing : pairings_) {
      for (int i = 0; i < kPoints; ++i) sum += pairing.weight * apart(pairing, i).squaredNorm();
    }
    return sum;
  }

  /// Of Gauss and Newton: sums of J^T J and J^T r over all points, J by central differences in
  /// metres of every unknown.
  struct NormalEquations {
    MatrixXd matrix;
    VectorXd gradient;
  };

  NormalEquations normalEquations() {
    const auto count = static_cast<Eigen::Index>(unknowns_.size());
    NormalEquations sums{MatrixXd::Zero(count, count), VectorXd::Zero(count)};
    for (const Pairing& pairing : pairings_) {
      std::vector<Eigen::Index> moving;
      for (const int panel : pairing.panels) {
        moving.insert(moving.end(), unknowns_of_[panel].begin(), unknowns_of_[panel].end());
      }
      for (int point = 0; point < kPoints; ++point) addPoint(pairing, point, moving, sums);
    }
    return sums;
  }

  void addPoint(const Pairing& pairing, int point, const std::vector<Eigen::Index>& moving,
                NormalEquations& sums) {
    const Vector3d error = apart(pairing, point);
    std::vector<Vector3d> columns;
    for (const Eigen::Index index : moving) {
      const Unknown& unknown = unknowns_[static_cast<std::size_t>(index)];
      const double value = *unknown.value;
      *unknown.value = value + kStep / unknown.metres;
      const Vector3d after = apart(pairing, point);
      *unknown.value = value - kStep / unknown.metres;
      columns.emplace_back((after - apart(pairing, point)) / (2.0 * kStep));
      *unknown.value = value;
    }
    for (std::size_t i = 0; i < moving.size(); ++i) {
      sums.gradient[moving[i]] += pairing.weight * columns[i].dot(error);
      for (std::size_t k = 0; k < moving.size(); ++k) {
        sums.matrix(moving[i], moving[k]) += pairing.weight * columns[i].dot(columns[k]);
      }
    }
  }

  void minimise() {
    if (unknowns_.empty() || pairings_.empty()) return;
    double error = cost();
    double damping = 1e-3;
    for (int step = 0; step < kMostSteps; ++step) {
      const NormalEquations sums = normalEquations();
      const double scale = sums.matrix.diagonal().maxCoeff();
      if (!(scale > 0.0)) return;
      MatrixXd damped = sums.matrix;
      damped.diagonal().array() += damping * scale;
      const VectorXd change = -damped.ldlt().solve(sums.gradient);
      move(change);
      const double moved = cost();
      if (isAllowed() && moved <= error) {
        error = moved;
        damping = std::max(1e-9, 0.2 * damping);
        if (change.cwiseAbs().maxCoeff() <= kConverged) return;
      } else {
        move(-change);
        damping *= 5.0;
        if (damping > 1e6) return;
      }
    }
  }

  /// No panel beyond the tip of its cone.
  bool isAllowed() const {
    return std::all_of(panels_.begin(), panels_.end(), [](const PanelToPlace& panel) {
      return panel.pose || panel.surface.radiusAt(panel.place.height) >= kLeastRadius;
    });
  }

  void move(const VectorXd& metres) {
    for (std::size_t k = 0; k < unknowns_.size(); ++k) {
      *unknowns_[k].value += metres[static_cast<Eigen::Index>(k)] / unknowns_[k].metres;
    }
  }

  struct Unknown {
    double* value;
    double metres;  // that the panel moves per unit of the value
  };

  const Pattern& pattern_;
  std::vector<PanelToPlace>& panels_;
  std::vector<bool> placed_;
  std::vector<Pairing> pairings_;
  std::vector<Unknown> unknowns_;
  std::vector<std::vector<Eigen::Index>> unknowns_of_;  // per panel
};

}  // namespace

void placeBySeams(const Pattern& pattern, const std::vector<double>& gaps,
                  std::vector<PanelToPlace>& panels) {
  Placement(pattern, gaps, panels).run();
}

}  // namespace haptex::garment
