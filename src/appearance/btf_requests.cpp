#include "haptex/appearance/btf_requests.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <future>
#include <stdexcept>

#include "haptex/appearance/btf_measures.h"
#include "haptex/base/require.h"
#include "haptex/base/whole_file.h"

namespace haptex::appearance {
namespace {

using Eigen::Vector3f;

void requireSound(const std::vector<BtfRequest>& requests) {
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const auto& [view, light, seen, width] = requests[i];
    const bool sound = Vector3f(view.data()).allFinite() && view[2] > 0.0f &&
                       Vector3f(light.data()).allFinite() && light[2] > 0.0f &&
                       std::isfinite(seen[0]) && std::isfinite(seen[1]) && std::isfinite(width) &&
                       width >= 0.0f;
    if (sound) continue;
    base::refuse("request ", i, ": view (", view[0], ", ", view[1], ", ", view[2], "), light (",
                 light[0], ", ", light[1], ", ", light[2], "), place (", seen[0], ", ", seen[1],
                 "), width ", width,
                 ": allowed are finite numbers, directions with z > 0, and a width of at least 0");
  }
}

/// Spread evenly over the square: multiples of the inverses of the plastic number and its square
/// (Roberts, The unreasonable effectiveness of quasirandom sequences, 2018), on from request to
/// request.
void placesOf(const BtfRequest& request, std::size_t number, double texel,
              std::vector<Eigen::Vector2d>& places) {
  constexpr double kMost = 16.0;
  constexpr double kAlongWeft = 0.7548776662466927, kAlongWarp = 0.5698402909980532;
  const double texels = request.width / texel;
  const auto count = static_cast<std::size_t>(std::clamp(std::ceil(texels * texels), 1.0, kMost));
  places.clear();
  const Eigen::Vector2d middle(request.seen[0], request.seen[1]);
  for (std::size_t i = 0; i < count; ++i) {
    const auto place = static_cast<double>(number * count + i);
    const Eigen::Vector2d share(std::fmod(kAlongWeft * place, 1.0),
                                std::fmod(kAlongWarp * place, 1.0));
    const Eigen::Vector2d aside = share - Eigen::Vector2d::Constant(0.5);
    places.emplace_back(count > 1 ? middle + request.width * aside : middle);
  }
}

void evaluate(const Btf& btf, const std::vector<BtfRequest>& requests, std::size_t first,
              std::size_t count, std::vector<Radiance>& values) {
  const double texel = btf.surface().size().x() / btf.surface().columns();
  std::vector<Eigen::Vector2d> places;
  for (std::size_t i = first; i < first + count; ++i) {
    const Vector3f view(requests[i].view.data()), light(requests[i].light.data());
    const Btf::Pair pair = btf.pair(view.cast<double>(), light.cast<double>());
    placesOf(requests[i], i, texel, places);
    const Eigen::Vector3d value = meanRadiance(pair, places);
    for (int channel = 0; channel < 3; ++channel) {
      values[i][channel] = static_cast<float>(value[channel]);
    }
  }
}

}  // namespace

std::vector<Radiance> radianceOf(const Btf& btf, const std::vector<BtfRequest>& requests,
                                 int threads) {
  requireSound(requests);
  std::vector<Radiance> values(requests.size());
  const std::size_t share = requests.size() / threads + 1;
  std::vector<std::future<void>> parts;
  for (std::size_t first = 0; first < requests.size(); first += share) {
    const std::size_t count = std::min(share, requests.size() - first);
    parts.push_back(std::async(std::launch::async, [&btf, &requests, &values, first, count] {
      evaluate(btf, requests, first, count, values);
    }));
  }
  for (std::future<void>& part : parts) part.get();
  return values;
}

std::vector<BtfRequest> readRequests(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = file ? static_cast<std::streamoff>(file.tellg()) : -1;
  if (size < 0) throw std::runtime_error(path + ": cannot be read");
  if (size % static_cast<std::streamoff>(sizeof(BtfRequest)) != 0) {
    throw std::runtime_error(path + ": has " + std::to_string(size) +
                             " bytes: allowed are records of 36");
  }
  std::vector<BtfRequest> requests(static_cast<std::size_t>(size) / sizeof(BtfRequest));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(requests.data()), size);
  if (!file) throw std::runtime_error(path + ": cannot be read");
  return requests;
}

void writeRadiance(const std::vector<Radiance>& values, const std::string& path) {
  base::writeWholeFile(
      path, {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Radiance)});
}

}  // namespace haptex::appearance
