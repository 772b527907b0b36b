#include "haptex/garment/triangulation/seam_divisions.h"

#include <algorithm>

namespace haptex::garment {
namespace {

// Corners of both sides that are nearer to each other than this part of an edge meet.
constexpr double kSameCorner = 0.25;
constexpr double kSamePlace = 1e-9;  // of a side

/// Linear between places that belong to each other, both ascending.
double between(const std::vector<double>& from, const std::vector<double>& to, double at) {
  const auto next = std::upper_bound(from.begin() + 1, from.end() - 1, at);
  const auto i = next - from.begin();
  const double share = (at - from[i - 1]) / (from[i] - from[i - 1]);
  return share >= 1.0 ? to[i] : to[i - 1] + share * (to[i] - to[i - 1]);
}

/// One side, by lengths along it from its start (m).
class Side {
 public:
  Side(const Pattern& pattern, const SeamSide& side)
      : outline_(pattern.panels[side.panel].outlines[side.outline]),
        side_(side),
        edges_(sewnEdges(pattern, side)),
        passed_(passedLengths(pattern, side)) {}

  double length() const { return passed_.back(); }

  /// As shares of the length, its ends among them.
  std::vector<double> corners() const {
    std::vector<double> all = {0.0};
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      std::vector<double> lengths = cornerLengths(curve(i));
      if (side_.reversed) {
        std::reverse(lengths.begin(), lengths.end());
        for (double& length : lengths) length = curve(i).length() - length;
      }
      for (std::size_t k = 1; k < lengths.size(); ++k) {
        all.push_back((passed_[i] + lengths[k]) / length());
      }
    }
    all.back() = 1.0;
    return all;
  }

  /// @param from, to shares between which there is no corner
  int parts(double from, double to, double edge_length, double tolerance) const {
    const std::size_t i = edgeAt(0.5 * (from + to));
    const auto [begin, end] = std::minmax({along(i, from), along(i, to)});
    return fewestParts(curve(i), begin, end, edge_length, tolerance);
  }

  bool isDivided(const EdgeDivisions& divisions) const {
    return std::any_of(edges_.begin(), edges_.end(),
                       [&](int edge) { return !divisions[side_.outline][edge].empty(); });
  }

  /// @return whether it was not divided there
  bool divideAt(double share, EdgeDivisions& divisions) const {
    const std::size_t i = edgeAt(share);
    const double length = along(i, share), same = kSamePlace * this->length();
    std::vector<double>& lengths = divisions[side_.outline][edges_[i]];
    const auto next = std::lower_bound(lengths.begin(), lengths.end(), length - same);
    if (next == lengths.end() || *next <= length + same) return false;
    lengths.insert(next, length);
    return true;
  }

  /// @param shares with the corners among them
  void divide(const std::vector<double>& shares, EdgeDivisions& divisions) const {
    for (std::size_t k = 1; k < shares.size(); ++k) {
      const std::size_t i = edgeAt(0.5 * (shares[k - 1] + shares[k]));
      std::vector<double>& lengths = divisions[side_.outline][edges_[i]];
      if (lengths.empty()) lengths.push_back(along(i, shares[k - 1]));
      lengths.push_back(along(i, shares[k]));
    }
    for (const int edge : edges_) {
      std::vector<double>& lengths = divisions[side_.outline][edge];
      if (side_.reversed) std::reverse(lengths.begin(), lengths.end());
      lengths.front() = 0.0;
      lengths.back() = outline_[edge].curve.length();
    }
  }

 private:
  const Curve& curve(std::size_t i) const { return outline_[edges_[i]].curve; }
  std::size_t edgeAt(double share) const {
    const auto next = std::upper_bound(passed_.begin() + 1, passed_.end() - 1, share * length());
    return static_cast<std::size_t>(next - passed_.begin()) - 1;
  }
  /// m, along the edge in the direction of the outline.
  double along(std::size_t i, double share) const {
    const double passed = share * length() - passed_[i];
    return side_.reversed ? curve(i).length() - passed : passed;
  }

  const Outline& outline_;
  const SeamSide& side_;
  std::vector<int> edges_;
  std::vector<double> passed_;
};

/// Ends and corners of both sides, where they meet each other.
SeamPlaces meetingCorners(const Side& first, const Side& second, double edge_length) {
  const std::vector<double> a = first.corners(), b = second.corners();
  const double same = kSameCorner * edge_length / std::min(first.length(), second.length());
  SeamPlaces meeting = {{0.0}, {0.0}};
  std::size_t j = 1;
  for (std::size_t i = 1; i + 1 < a.size(); ++i) {
    while (j + 1 < b.size() && b[j] <= a[i] - same) ++j;
    if (j + 1 >= b.size() || b[j] >= a[i] + same) continue;
    meeting.first.push_back(a[i]);
    meeting.second.push_back(b[j++]);
  }
  meeting.first.push_back(1.0);
  meeting.second.push_back(1.0);
  SeamPlaces all = meeting;
  for (std::size_t i = 1; i + 1 < a.size(); ++i) {
    if (std::count(meeting.first.begin(), meeting.first.end(), a[i]) > 0) continue;
    all.first.push_back(a[i]);
    all.second.push_back(between(meeting.first, meeting.second, a[i]));
  }
  for (std::size_t i = 1; i + 1 < b.size(); ++i) {
    if (std::count(meeting.second.begin(), meeting.second.end(), b[i]) > 0) continue;
    all.first.push_back(between(meeting.second, meeting.first, b[i]));
    all.second.push_back(b[i]);
  }
  std::sort(all.first.begin(), all.first.end());
  std::sort(all.second.begin(), all.second.end());
  return all;
}

}  // namespace

double SeamPlaces::onFirst(double second_share) const {
  return between(second, first, second_share);
}

double SeamPlaces::onSecond(double first_share) const {
  return between(first, second, first_share);
}

bool divideAt(const Pattern& pattern, const SeamSide& side, double share,
              EdgeDivisions& divisions) {
  return Side(pattern, side).divideAt(share, divisions);
}

std::vector<int> sewnEdges(const Pattern& pattern, const SeamSide& side) {
  std::vector<int> edges = edgesOf(pattern, side);
  if (side.reversed) std::reverse(edges.begin(), edges.end());
  return edges;
}

std::vector<double> passedLengths(const Pattern& pattern, const SeamSide& side) {
  std::vector<double> passed = {0.0};
  for (const int edge : sewnEdges(pattern, side)) {
    const Curve& curve = pattern.panels[side.panel].outlines[side.outline][edge].curve;
    passed.push_back(passed.back() + curve.length());
  }
  return passed;
}

SeamDivisions divideSeams(const Pattern& pattern, double edge_length, double tolerance) {
  SeamDivisions all;
  for (const Panel& panel : pattern.panels) {
    EdgeDivisions& divisions = all.panels.emplace_back();
    for (const Outline& outline : panel.outlines) divisions.emplace_back(outline.size());
  }
  for (const Seam& seam : pattern.seams) {
    const Side first(pattern, seam.sides[0]), second(pattern, seam.sides[1]);
    const SeamPlaces corners = meetingCorners(first, second, edge_length);
    SeamPlaces& places = all.seams.emplace_back();
    for (std::size_t i = 1; i < corners.first.size(); ++i) {
      const double from = corners.first[i - 1], to = corners.first[i];
      const double other_from = corners.second[i - 1], other_to = corners.second[i];
      const int parts = std::max(first.parts(from, to, edge_length, tolerance),
                                 second.parts(other_from, other_to, edge_length, tolerance));
      for (int k = 0; k < parts; ++k) {
        places.first.push_back(from + (to - from) * k / parts);
        places.second.push_back(other_from + (other_to - other_from) * k / parts);
      }
    }
    places.first.push_back(1.0);
    places.second.push_back(1.0);
    EdgeDivisions& of_first = all.panels[seam.sides[0].panel];
    EdgeDivisions& of_second = all.panels[seam.sides[1].panel];
    // An edge that an earlier seam has divided stays as it is.
    if (first.isDivided(of_first) || second.isDivided(of_second)) continue;
    first.divide(places.first, of_first);
    second.divide(places.second, of_second);
  }
  return all;
}

}  // namespace haptex::garment
