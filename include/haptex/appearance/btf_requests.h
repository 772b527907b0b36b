// Many values of a bidirectional texture function at once, for a renderer.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "haptex/appearance/btf.h"

namespace haptex::appearance {

/// What is seen of which light. 36 bytes, which are also a record of a file.
struct BtfRequest {
  std::array<float, 3> view;   ///< towards the eye, of any length
  std::array<float, 3> light;  ///< towards the light, of any length
  std::array<float, 2> seen;   ///< m, along weft and warp
  float width;                 ///< m, >= 0, of the square around it that is seen
};
static_assert(sizeof(BtfRequest) == 36);

/// Red, green and blue: Btf::Pair::at(), mean over up to 16 places of the square, as many as it has
/// texels, which differ from request to request.
using Radiance = std::array<float, 3>;

/// @param threads >= 1, among which the requests are shared out
/// @throws std::invalid_argument naming the first request with a number that is not finite, or a
///   direction that does not come out of the fabric's face, or a width below 0
std::vector<Radiance> radianceOf(const Btf& btf, const std::vector<BtfRequest>& requests,
                                 int threads);

/// Records without a header, numbers as this machine has them.
/// @throws std::runtime_error naming the path if it cannot be read or has a part of a record
std::vector<BtfRequest> readRequests(const std::string& path);
/// @throws std::runtime_error naming the path if it cannot be written
void writeRadiance(const std::vector<Radiance>& values, const std::string& path);

}  // namespace haptex::appearance
