#include "haptex/mesh/seam_partners.h"

#include "haptex/mesh/seam_edges.h"

namespace haptex::mesh {

std::vector<std::array<int, 2>> partners(const Seam& seam) {
  std::vector<std::array<int, 2>> pairs;
  std::size_t j = 0;
  for (std::size_t i = 0; i < seam.first.size(); ++i) {
    const double place = seam.first_places[i];
    while (j < seam.second.size() && seam.second_places[j] < place - kSamePlace) ++j;
    if (j == seam.second.size()) break;
    if (seam.second_places[j] > place + kSamePlace) continue;
    pairs.push_back({seam.first[i], seam.second[j]});
  }
  return pairs;
}

}  // namespace haptex::mesh
