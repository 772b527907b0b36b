#include "haptex/oracles/scenes/sewn_panels.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "haptex/base/quantity.h"
#include "haptex/base/repeatable_random.h"

namespace haptex::oracles {
namespace {

using Eigen::Vector2d;

constexpr int kCellsAcross = 5;  // of a panel

/// Where the cut is at a height: u, m. @param corners of the polyline that it is
double cutAt(SeamShape shape, const std::vector<double>& corners, double place) {
  const double straight = 0.5 * SewnPanels::kWidth;
  if (shape == SeamShape::kStraight) return straight;
  if (shape == SeamShape::kDart) return straight + 0.02 * place;
  const auto curve = [&](double at) { return straight + 0.015 * std::sin(M_PI * at); };
  const auto next = std::upper_bound(corners.begin() + 1, corners.end() - 1, place);
  const double from = *(next - 1), to = *next;
  return curve(from) + (place - from) / (to - from) * (curve(to) - curve(from));
}

void addPanel(bool right, SeamShape shape, const std::vector<double>& corners,
              const std::vector<double>& places, base::RepeatableRandom& random, SewnPanels& made) {
  const int rows = static_cast<int>(places.size());
  const int first = static_cast<int>(made.flat.size());
  std::vector<int>& edge = right ? made.seam.second : made.seam.first;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i <= kCellsAcross; ++i) {
      Vector2d at(static_cast<double>(i) / kCellsAcross, places[j]);
      const bool border = i == 0 || i == kCellsAcross || j == 0 || j == rows - 1;
      if (!border) {
        at.x() += random.uniform(-0.2, 0.2) / kCellsAcross;
        at.y() += random.uniform(-0.2, 0.2) *
                  std::min(places[j + 1] - places[j], places[j] - places[j - 1]);
      }
      const double cut = cutAt(shape, corners, at.y());
      const double u = right ? cut + at.x() * (SewnPanels::kWidth - cut) : at.x() * cut;
      const int particle = static_cast<int>(made.flat.size());
      const bool on_seam = right ? i == 0 : i == kCellsAcross;
      if (on_seam) edge.push_back(particle);
      if (border && (!on_seam || j == 0 || j == rows - 1)) made.border.push_back(particle);
      made.flat.emplace_back(u, at.y() * SewnPanels::kHeight);
    }
  }
  for (int j = 0; j + 1 < rows; ++j) {
    for (int i = 0; i < kCellsAcross; ++i) {
      const int a = first + j * (kCellsAcross + 1) + i, b = a + 1;
      const int c = a + kCellsAcross + 1, d = c + 1;
      if ((i + j) % 2 == 0) {
        made.mesh.triangles.push_back({a, b, d});
        made.mesh.triangles.push_back({a, d, c});
      } else {
        made.mesh.triangles.push_back({a, b, c});
        made.mesh.triangles.push_back({b, d, c});
      }
      made.mesh.triangle_panels.insert(made.mesh.triangle_panels.end(), 2, right ? 1 : 0);
    }
  }
}

/// The right side's tip of the dart is the left side's.
void joinTip(SewnPanels& made) {
  const int kept = made.seam.first.front(), gone = made.seam.second.front();
  const auto rename = [&](int& particle) {
    if (particle == gone) {
      particle = kept;
    } else if (particle > gone) {
      --particle;
    }
  };
  made.flat.erase(made.flat.begin() + gone);
  made.border.erase(std::find(made.border.begin(), made.border.end(), gone));
  for (auto& triangle : made.mesh.triangles) {
    for (int& particle : triangle) rename(particle);
  }
  for (int& particle : made.seam.second) rename(particle);
  for (int& particle : made.border) rename(particle);
  for (int& particle : made.beside_ends) rename(particle);
}

}  // namespace

SewnPanels sewnPanels(SeamShape shape, const std::vector<double>& left,
                      const std::vector<double>& right, unsigned seed) {
  base::RepeatableRandom random(seed);
  SewnPanels made;
  addPanel(false, shape, left, left, random, made);
  const std::size_t first_right = made.flat.size();
  made.left_triangles = static_cast<int>(made.mesh.triangles.size());
  addPanel(true, shape, left, right, random, made);
  made.beside_ends = {made.seam.second.front() + 1, made.seam.second.back() + 1};
  made.seam.first_places = left;
  made.seam.second_places = right;
  made.mesh.panels = {{0, 0.0}, {0, 0.0}};
  if (shape == SeamShape::kDart) joinTip(made);
  made.mesh.rest_coordinates = made.flat;
  if (shape == SeamShape::kDart) {
    made.mesh.panels.clear();
    made.mesh.triangle_panels.clear();
    const Eigen::Rotation2Dd turn(-SewnPanels::kDartAngle);
    const Vector2d tip = made.flat[made.seam.first.front()];
    for (std::size_t i = first_right; i < made.flat.size(); ++i) {
      made.mesh.rest_coordinates[i] = tip + turn * (made.flat[i] - tip);
    }
  }
  made.mesh.initial_positions = mesh::flatPositions(made.mesh);
  return made;
}

double seamGap(const mesh::Seam& seam, const std::vector<Eigen::Vector3d>& positions) {
  const bool of_first = seam.first.size() > seam.second.size();
  const std::vector<int>& finer = of_first ? seam.first : seam.second;
  const std::vector<int>& coarser = of_first ? seam.second : seam.first;
  const std::vector<double>& places = of_first ? seam.first_places : seam.second_places;
  const std::vector<double>& ends = of_first ? seam.second_places : seam.first_places;
  double largest = 0.0;
  for (std::size_t i = 0; i < finer.size(); ++i) {
    std::size_t piece = 0;
    while (piece + 2 < ends.size() && ends[piece + 1] < places[i]) ++piece;
    const double share = (places[i] - ends[piece]) / (ends[piece + 1] - ends[piece]);
    const Eigen::Vector3d from = positions[coarser[piece]], to = positions[coarser[piece + 1]];
    largest = base::largerOrNaN(largest,
                                (positions[finer[i]] - (1.0 - share) * from - share * to).norm());
  }
  return largest;
}

std::vector<double> evenPlaces(int count) {
  std::vector<double> places;
  for (int i = 0; i < count; ++i) places.push_back(static_cast<double>(i) / (count - 1));
  return places;
}

std::vector<double> nestedPlaces(int count, int more) {
  std::vector<double> places = evenPlaces(count);
  for (int i = 0; i < more; ++i) places.push_back((i + 0.5) / (count - 1));
  std::sort(places.begin(), places.end());
  return places;
}

}  // namespace haptex::oracles
