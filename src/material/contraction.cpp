#include "haptex/material/contraction.h"

#include <algorithm>
#include <cmath>

namespace haptex::material {
namespace {

/// Geometric mean of the slopes of weft and warp without strain (N/m); 0 where one is not > 0.
double meanSlope(const Fabric& fabric) {
  const double weft = fabric.weft.elastic.evaluate(0.0).slope;
  const double warp = fabric.warp.elastic.evaluate(0.0).slope;
  return std::sqrt(std::max(0.0, weft) * std::max(0.0, warp));
}

}  // namespace

double contractionModulus(const Fabric& fabric) {
  return fabric.contraction ? *fabric.contraction * meanSlope(fabric) : 0.0;
}

double largestContraction(const Fabric& fabric) {
  const double weft = fabric.weft.elastic.minimumSlope();
  const double warp = fabric.warp.elastic.minimumSlope();
  const double at_rest = meanSlope(fabric);
  if (!(weft > 0.0 && warp > 0.0 && at_rest > 0.0)) return 0.0;
  return std::sqrt(weft * warp) / at_rest;
}

}  // namespace haptex::material
