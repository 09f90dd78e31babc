#include "evidence/rank_promise.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "evidence/constants.h"

namespace servodx {
using namespace evidence_constants;

RankPromise rank_promise(std::vector<double> scores, double false_alarm) {
  std::sort(scores.begin(), scores.end());
  const auto n = static_cast<double>(scores.size());
  const auto k = static_cast<std::size_t>(std::min(n, std::ceil((1.0 - false_alarm) * (n + 1.0) - count_rounding)));
  RankPromise out;
  out.threshold = scores[k - 1];
  out.promised = (n + 1.0 - static_cast<double>(k)) / (n + 1.0);
  out.promised_95 = 1.0 - std::pow(0.05, 1.0 / n);
  out.logs_needed = static_cast<int>(std::ceil(1.0 / false_alarm - count_rounding)) - 1;
  return out;
}

bool promise_kept(double promised, double asked) { return promised <= asked + rate_rounding; }

double rank_p_value(double score, const std::vector<double>& healthy) {
  long above = 1;
  for (const double s : healthy) above += s >= score;
  return static_cast<double>(above) / static_cast<double>(healthy.size() + 1);
}

}  // namespace servodx
