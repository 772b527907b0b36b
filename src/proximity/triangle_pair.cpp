#include "haptex/proximity/triangle_pair.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "haptex/proximity/triangle_edges.h"

namespace haptex::proximity {
namespace {

using Eigen::Vector3d;

bool isFraction(double number) { return number >= 0.0 && number <= 1.0; }

Vector3d cornerWeights(int corner) { return Vector3d::Unit(corner); }

// A triangle with its altitude, which is its second edge without the part along the first.
class Face {
 public:
  explicit Face(const Triangle& triangle)
      : origin_(triangle[0]), base_(triangle[1] - origin_), side_(triangle[2] - origin_) {
    base_square_ = base_.squaredNorm();
    if (base_square_ > 0.0) along_ = base_.dot(side_) / base_square_;
    altitude_ = side_ - along_ * base_;
    altitude_square_ = altitude_.squaredNorm();
    normal_ = base_.cross(altitude_).normalized();
  }

  // Whether a place projects into the triangle, and the weights of the corners there.
  bool project(const Vector3d& place, Vector3d& weights) const {
    if (base_square_ <= 0.0 || altitude_square_ <= 0.0) return false;
    const Vector3d offset = place - origin_;
    const double v = offset.dot(altitude_) / altitude_square_;
    const double u = offset.dot(base_) / base_square_ - v * along_;
    weights = Vector3d(1.0 - u - v, u, v);
    return isFraction(weights[0]) && isFraction(u) && isFraction(v);
  }

  double height(const Vector3d& place) const { return normal_.dot(place - origin_); }

 private:
  Vector3d origin_, base_, side_, altitude_, normal_;
  double base_square_, altitude_square_;
  double along_ = 0.0;  // where on the base the altitude stands
};

class PairSearch {
 public:
  PairSearch(const Triangle& first, const Triangle& second)
      : first_(first), second_(second), first_face_(first), second_face_(second) {}

  TrianglePoint run() {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        cornersAndEdges(i, j);
        edgeAndEdge(i, j);
      }
      cornerAndFace(i);
      edgeThroughFace(i);
    }
    return {std::sqrt(square_), weights_};
  }

 private:
  void consider(const Vector3d& weights, const Vector3d& of_first, const Vector3d& of_second) {
    const double square = (of_first - of_second).squaredNorm();
    if (square >= square_) return;
    square_ = square;
    weights_ = weights;
  }

  static Vector3d on(const Triangle& triangle, const Vector3d& weights) {
    return TrianglePoint{0.0, weights}.on(triangle);
  }

  static Vector3d onEdge(const Triangle& triangle, int edge, double fraction) {
    return triangle[edge] + fraction * (triangle[(edge + 1) % 3] - triangle[edge]);
  }

  // Corner i of the first with edge j of the second, edge i of the first with corner j.
  void cornersAndEdges(int i, int j) {
    const double t = nearestFraction(first_[i], second_[j], second_[(j + 1) % 3]);
    consider(cornerWeights(i), first_[i], onEdge(second_, j, t));
    const double s = nearestFraction(second_[j], first_[i], first_[(i + 1) % 3]);
    consider(edgeWeights(i, s), onEdge(first_, i, s), second_[j]);
  }

  // Inside of both edges; their ends are corners.
  void edgeAndEdge(int i, int j) {
    const auto inside =
        nearestInside(first_[i], first_[(i + 1) % 3], second_[j], second_[(j + 1) % 3]);
    if (!inside) return;
    const auto [s, t] = *inside;
    consider(edgeWeights(i, s), onEdge(first_, i, s), onEdge(second_, j, t));
  }

  void cornerAndFace(int i) {
    Vector3d weights;
    if (second_face_.project(first_[i], weights)) {
      consider(cornerWeights(i), first_[i], on(second_, weights));
    }
    if (first_face_.project(second_[i], weights)) {
      consider(weights, on(first_, weights), second_[i]);
    }
  }

  void edgeThroughFace(int i) {
    double fraction;
    Vector3d weights;
    if (crosses(second_face_, first_, i, fraction, weights)) {
      consider(edgeWeights(i, fraction), onEdge(first_, i, fraction), on(second_, weights));
    }
    if (crosses(first_face_, second_, i, fraction, weights)) {
      consider(weights, on(first_, weights), onEdge(second_, i, fraction));
    }
  }

  static bool crosses(const Face& face, const Triangle& triangle, int edge, double& fraction,
                      Vector3d& weights) {
    const double begin = face.height(triangle[edge]);
    const double end = face.height(triangle[(edge + 1) % 3]);
    if ((begin > 0.0) == (end > 0.0)) return false;
    fraction = begin / (begin - end);
    return face.project(onEdge(triangle, edge, fraction), weights);
  }

  const Triangle& first_;
  const Triangle& second_;
  Face first_face_, second_face_;
  double square_ = std::numeric_limits<double>::infinity();
  Vector3d weights_ = cornerWeights(0);
};

}  // namespace

TrianglePoint closestPoint(const Triangle& triangle, const Triangle& other) {
  return PairSearch(triangle, other).run();
}

}  // namespace haptex::proximity
