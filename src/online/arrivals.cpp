#include "online/arrivals.h"

#include <algorithm>
#include <utility>

namespace servodx {

namespace k = online_constants;

bool Arrivals::add(const Sample& sample) {
  if (sample.time == last_taken) {
    ++counts.repeated;
    return false;
  }
  if (sample.time < last_taken) {
    ++counts.late;
    if (++late_in_a_row_ < k::late_is_set_back) return false;
    part_.clear();
    last_taken = -1e300;
  }
  late_in_a_row_ = 0;
  const auto at = std::lower_bound(part_.begin(), part_.end(), sample.time,
                                   [](const Sample& s, double time) { return s.time < time; });
  if (at != part_.end() && at->time == sample.time) {
    ++counts.repeated;
    return false;
  }
  part_.insert(at, sample);
  ++counts.taken;
  const double begun = last_taken > -1e300 ? last_taken : part_.front().time;
  // A rounding of the time stamps must not make a part a sample longer.
  return part_.back().time - begun >= k::part * (1 - 1e-6) || part_.size() >= k::most_in_part;
}

std::vector<Sample> Arrivals::take() {
  if (!part_.empty()) last_taken = part_.back().time;
  return std::exchange(part_, {});
}

}  // namespace servodx
