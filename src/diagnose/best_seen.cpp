#include "diagnose/best_seen.h"

#include <cmath>
#include <cstddef>

namespace servodx {

std::vector<Visible> best_seen(const std::vector<Promise>& promises) {
  std::vector<Visible> best;
  for (const Promise& p : promises)
    for (std::size_t k = 0; k < p.faults.size(); ++k) {
      if (best.size() <= k)
        best.push_back(p.faults[k]), best.back().deviates_at_least = best.back().deviates_at_typical = 0;
      best[k].deviates_at_least =
          std::fmax(best[k].deviates_at_least, p.faults[k].deviates_at_least);  // NaN where a simulation failed
      best[k].deviates_at_typical = std::fmax(best[k].deviates_at_typical, p.faults[k].deviates_at_typical);
    }
  return best;
}

}  // namespace servodx
