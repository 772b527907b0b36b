#include "haptex/oracles/exact/moving_elements.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace haptex::oracles {
namespace {

using Eigen::Vector3d;
using proximity::ElementPairKind;
__extension__ typedef __int128 Whole;

/// A polynomial of a time with whole coefficients.
template <int kDegree>
struct Polynomial {
  std::array<Whole, kDegree + 1> factors{};  // of 1, t, t^2, ...

  /// Times 2^(kDegree bits), at time / 2^bits: a whole number.
  Whole at(Whole time, int bits) const {
    Whole sum = 0;
    for (int i = kDegree; i >= 0; --i)
      sum = sum * time + factors[i] * (Whole{1} << (bits * (kDegree - i)));
    return sum;
  }
  /// Not less than the largest slope between 0 and 1.
  Whole steepest() const {
    Whole sum = 0;
    for (int i = 1; i <= kDegree; ++i) sum += i * (factors[i] < 0 ? -factors[i] : factors[i]);
    return sum;
  }
  /// Whether it is positive between time and time + 1, in units of 2^-bits.
  bool isPositive(Whole time, int bits) const {
    return at(time, bits) > steepest() << (bits * (kDegree - 1));
  }
};

template <int kFirst, int kSecond>
Polynomial<kFirst + kSecond> operator*(const Polynomial<kFirst>& a, const Polynomial<kSecond>& b) {
  Polynomial<kFirst + kSecond> product;
  for (int i = 0; i <= kFirst; ++i) {
    for (int j = 0; j <= kSecond; ++j) product.factors[i + j] += a.factors[i] * b.factors[j];
  }
  return product;
}
template <int kDegree>
Polynomial<kDegree> operator+(Polynomial<kDegree> a, const Polynomial<kDegree>& b) {
  for (int i = 0; i <= kDegree; ++i) a.factors[i] += b.factors[i];
  return a;
}
template <int kDegree>
Polynomial<kDegree> operator-(Polynomial<kDegree> a, const Polynomial<kDegree>& b) {
  for (int i = 0; i <= kDegree; ++i) a.factors[i] -= b.factors[i];
  return a;
}

template <int kDegree>
using Vector = std::array<Polynomial<kDegree>, 3>;

Vector<1> between(const MovingElements& elements, int from, int to) {
  Vector<1> way;
  for (int k = 0; k < 3; ++k) {
    const auto begin = static_cast<Whole>(elements.begin[to][k] - elements.begin[from][k]);
    const auto end = static_cast<Whole>(elements.end[to][k] - elements.end[from][k]);
    way[k].factors = {begin, end - begin};
  }
  return way;
}
template <int kFirst, int kSecond>
Polynomial<kFirst + kSecond> dot(const Vector<kFirst>& a, const Vector<kSecond>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <int kFirst, int kSecond>
Vector<kFirst + kSecond> cross(const Vector<kFirst>& a, const Vector<kSecond>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// What has to be positive for the place where four vertices are in a plane to be in both elements.
std::array<Polynomial<4>, 4> insideOf(const MovingElements& e) {
  if (e.kind == ElementPairKind::kVertexTriangle) {
    const auto normal = cross(between(e, 1, 2), between(e, 1, 3));
    std::array<Polynomial<4>, 4> inside;
    for (int i = 0; i < 3; ++i) {
      const int a = 1 + i, b = 1 + (i + 1) % 3;
      inside[i] = dot(normal, cross(between(e, a, b), between(e, a, 0)));
    }
    inside[3] = dot(normal, normal);
    return inside;
  }
  const auto first = between(e, 0, 1), second = between(e, 2, 3), offset = between(e, 0, 2);
  const auto normal = cross(first, second);
  const auto whole = dot(normal, normal);
  const auto of_first = dot(cross(offset, second), normal);
  const auto of_second = dot(cross(offset, first), normal);
  return {of_first, whole - of_first, of_second, whole - of_second};
}

constexpr int kPieces = 3;  // 2^kPieces intervals are searched
constexpr int kBits = 20;   // of the times

std::optional<double> certainContact(const MovingElements& e) {
  const Polynomial<3> volume = dot(between(e, 0, 1), cross(between(e, 0, 2), between(e, 0, 3)));
  const std::array<Polynomial<4>, 4> inside = insideOf(e);
  for (int piece = 0; piece < 1 << kPieces; ++piece) {
    Whole begin = Whole{piece} << (kBits - kPieces), end = Whole{piece + 1} << (kBits - kPieces);
    const bool is_above = volume.at(begin, kBits) > 0;
    if (volume.at(begin, kBits) == 0 || volume.at(end, kBits) == 0 ||
        is_above == (volume.at(end, kBits) > 0)) {
      continue;
    }
    while (end - begin > 1) {
      const Whole middle = (begin + end) / 2;
      // At zero either half will do.
      ((volume.at(middle, kBits) > 0) == is_above ? begin : end) = middle;
    }
    const bool is_inside = std::all_of(inside.begin(), inside.end(), [&](const auto& condition) {
      return condition.isPositive(begin, kBits);
    });
    if (is_inside) return std::ldexp(static_cast<double>(end), -kBits);
  }
  return {};
}

}  // namespace

Vector3d MovingElementCases::place(int reach) {
  const double x = number(-reach, reach), y = number(-reach, reach), z = number(-reach, reach);
  return {x, y, z};
}

MovingElements MovingElementCases::next() { return count_++ % 2 == 0 ? constructed() : random(); }

/// Elements that touch at a chosen time, in units that whole weights divide.
MovingElements MovingElementCases::constructed() {
  MovingElements e;
  e.kind = number(0, 1) == 0 ? ElementPairKind::kVertexTriangle : ElementPairKind::kEdgeEdge;
  const int reach = 1 << number(0, 10);
  constexpr int kUnit = 16;  // of weights
  std::array<Vector3d, 4> at, way;
  for (int i = 0; i < 4; ++i) {
    at[i] = kUnit * place(reach);
    way[i] = place(number(0, 3) == 0 ? 0 : 4 * reach * kUnit);
  }
  const int degenerate = number(0, 9);
  if (degenerate == 0) at[2] = at[3];                    // an edge, or a triangle without area
  if (degenerate == 1) at[1] = at[2] = at[3];            // a point
  if (degenerate == 2) at[3] = 2.0 * at[2] - at[1];      // in a line, or parallel edges
  if (degenerate == 3) at[3] = at[2] + (at[1] - at[0]);  // parallel edges
  if (degenerate == 4) {                                 // all in a plane, for all times
    for (int i = 0; i < 4; ++i) at[i].z() = way[i].z() = 0.0;
  }
  if (degenerate == 5) std::fill(way.begin(), way.end(), way[0]);  // none moves against another
  if (e.kind == ElementPairKind::kVertexTriangle) {
    const int first = number(0, kUnit), second = number(0, kUnit - first);
    at[0] = (first * at[1] + second * at[2] + (kUnit - first - second) * at[3]) / kUnit;
  } else {
    // The second edge is moved to where it meets the first.
    const int first = number(0, 3) == 0 ? 0 : number(0, kUnit), second = number(0, kUnit);
    const Vector3d meets = (first * at[1] + (kUnit - first) * at[0]) / kUnit;
    const Vector3d moved = (second * at[3] + (kUnit - second) * at[2]) / kUnit;
    at[2] += meets - moved;
    at[3] += meets - moved;
  }
  const int bits = number(0, 8);
  const double time = std::ldexp(number(0, 1 << bits), -bits);
  const double scale = std::ldexp(1.0, number(-24, 4));
  for (int i = 0; i < 4; ++i) {
    e.begin[i] = scale * (at[i] - time * way[i]);
    e.end[i] = scale * (at[i] + (1.0 - time) * way[i]);
  }
  e.contact = time;
  return e;
}

MovingElements MovingElementCases::random() {
  MovingElements e;
  e.kind = number(0, 1) == 0 ? ElementPairKind::kVertexTriangle : ElementPairKind::kEdgeEdge;
  const int reach = number(1, 6);
  for (int i = 0; i < 4; ++i) {
    e.begin[i] = place(reach);
    e.end[i] = place(reach);
  }
  e.contact = certainContact(e);
  return e;
}

}  // namespace haptex::oracles
