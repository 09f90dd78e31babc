#include "evidence/tail_law.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "evidence/constants.h"

namespace servodx {
using namespace evidence_constants;

TailLaw::TailLaw(std::vector<double> healthy, UsualExcess usual) : healthy_(std::move(healthy)) {
  sum_ = usual.mean * usual.logs;
  for (double& e : healthy_) sum_ += e = std::max(0.0, e);
  logs_ = usual.logs + static_cast<double>(healthy_.size());
}

double TailLaw::by_law(double excess, double sum, double logs) const { return std::pow(1 + excess / sum, -logs); }

double TailLaw::chance(double excess) const {
  if (!(excess > 0)) return 1;
  const double law = by_law(excess, sum_, logs_);
  const auto as_large = std::count_if(healthy_.begin(), healthy_.end(), [&](double e) { return e >= excess; });
  const double rank = static_cast<double>(as_large + 1) / static_cast<double>(healthy_.size() + 1);
  return as_large > 0 ? std::max(law, rank) : law;
}

double TailLaw::excess_at(double rate) const { return sum_ * (std::pow(rate, -1 / logs_) - 1); }

int TailLaw::logs_needed(double excess, double asked, double share) const {
  const auto here = static_cast<int>(healthy_.size());
  const double mean = sum_ / logs_;
  for (int n = here; n <= most_logs; ++n) {
    const double logs = logs_ + (n - here);
    if (by_law(excess, mean * logs, logs) <= rate_of_question(asked, n, share)) return n == here ? 0 : n;
  }
  return -1;
}

double rate_of_question(double asked, int healthy_logs, double share) {
  return share * std::max(asked, 1.0 / (healthy_logs + 1.0));
}

}  // namespace servodx
