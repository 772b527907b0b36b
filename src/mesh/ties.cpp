#include "haptex/mesh/ties.h"

#include <cmath>
#include <map>

#include "haptex/base/require.h"

namespace haptex::mesh {
namespace {

void requireSound(const Tie& tie, std::size_t particle_count) {
  for (const int particle : {tie.particle, tie.ends[0], tie.ends[1]}) {
    if (particle >= 0 && particle < static_cast<int>(particle_count)) continue;
    base::refuse("particle ", tie.particle, " is tied to ", tie.ends[0], " and ", tie.ends[1],
                 "; the mesh has particles 0 to ", particle_count - 1);
  }
  if (tie.ends[0] == tie.ends[1]) {
    base::refuse("particle ", tie.particle, " is tied to particle ", tie.ends[0],
                 " twice; the two ends of the edge must differ");
  }
  if (tie.particle == tie.ends[0] || tie.particle == tie.ends[1]) {
    base::refuse("particle ", tie.particle, " is tied to itself");
  }
  if (!std::isfinite(tie.share) || tie.share < 0.0 || tie.share > 1.0) {
    base::refuse("particle ", tie.particle, " is tied with the share ", tie.share,
                 "; it must lie from 0 to 1");
  }
}

/// Depth first, so that every tie is followed once.
class Resolution {
 public:
  Resolution(const std::vector<Tie>& ties, std::size_t particle_count)
      : tie_of_(particle_count, nullptr),
        progress_(particle_count, Progress::kOpen),
        shares_(particle_count) {
    for (const Tie& tie : ties) {
      requireSound(tie, particle_count);
      if (tie_of_[tie.particle] != nullptr) {
        base::refuse("particle ", tie.particle, " is tied twice; once is allowed");
      }
      tie_of_[tie.particle] = &tie;
    }
  }

  const std::map<int, double>& sharesOf(int particle) {
    std::map<int, double>& shares = shares_[particle];
    if (progress_[particle] == Progress::kDone) return shares;
    if (progress_[particle] == Progress::kBegun) {
      base::refuse("particle ", particle, " is tied to itself, directly or through others");
    }
    progress_[particle] = Progress::kBegun;
    if (const Tie* tie = tie_of_[particle]) {
      addShares(tie->ends[0], 1.0 - tie->share, shares);
      addShares(tie->ends[1], tie->share, shares);
    } else {
      shares[particle] = 1.0;
    }
    progress_[particle] = Progress::kDone;
    return shares;
  }

  bool isTied(int particle) const { return tie_of_[particle] != nullptr; }

 private:
  enum class Progress : char { kOpen, kBegun, kDone };

  void addShares(int end, double weight, std::map<int, double>& shares) {
    if (weight == 0.0) return;
    for (const auto& [particle, share] : sharesOf(end)) shares[particle] += weight * share;
  }

  std::vector<const Tie*> tie_of_;
  std::vector<Progress> progress_;
  std::vector<std::map<int, double>> shares_;
};

}  // namespace

std::vector<ResolvedTie> resolveTies(const std::vector<Tie>& ties, std::size_t particle_count) {
  std::vector<ResolvedTie> resolved;
  if (ties.empty()) return resolved;
  Resolution resolution(ties, particle_count);
  for (int i = 0; i < static_cast<int>(particle_count); ++i) {
    if (!resolution.isTied(i)) continue;
    ResolvedTie& tie = resolved.emplace_back(ResolvedTie{i, {}});
    for (const auto& [particle, weight] : resolution.sharesOf(i)) {
      tie.shares.push_back({particle, weight});
    }
  }
  return resolved;
}

}  // namespace haptex::mesh
