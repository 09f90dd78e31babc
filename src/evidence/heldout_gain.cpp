#include "evidence/heldout_gain.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

#include "base/random.h"
#include "evidence/constants.h"

namespace servodx {
namespace {

using namespace evidence_constants;

constexpr std::uint32_t bootstrap_stream = 0xb00f;  // of the seed's random numbers

double share_removed(double before, double after) { return before > 0 ? 1.0 - after / before : 0.0; }

}  // namespace

Interval heldout_gain(const std::vector<double>& before, const std::vector<double>& after, std::uint64_t seed,
                      int draws) {
  const std::size_t n = before.size();
  std::vector<double> drawn;
  for (int k = 0; k < draws; ++k) {
    Random random(seed, static_cast<std::uint32_t>(k), bootstrap_stream);
    double b = 0, a = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const auto pick = static_cast<std::size_t>(random.below(static_cast<std::uint32_t>(n)));
      b += before[pick], a += after[pick];
    }
    drawn.push_back(share_removed(b, a));
  }
  std::sort(drawn.begin(), drawn.end());
  const auto at = [&](int k) { return drawn[static_cast<std::size_t>(k)]; };
  return {share_removed(std::accumulate(before.begin(), before.end(), 0.0),
                        std::accumulate(after.begin(), after.end(), 0.0)),
          at(draws / tail), at(draws - 1 - draws / tail)};
}

}  // namespace servodx
