// The threshold that scores of fault-free logs set, and the rate of false alarms that it promises.
//
// Conformal (Vovk, Gammerman & Shafer 2005): a new log exchangeable with n healthy ones exceeds the k-th smallest of
// their scores with probability (n + 1 - k) / (n + 1). That rate is an average over baselines; `promised_95` bounds the
// rate of the largest score of this baseline with 95 % confidence. Logs of other tests are not exchangeable.
#pragma once
#include <vector>

namespace servodx {

struct RankPromise {
  double threshold = 0;
  double promised = 0;     // rate, on average over baselines
  double promised_95 = 0;  // rate, with 95 % confidence
  int logs_needed = 0;     // for the rate asked for
};

// At least one score; 0 < false_alarm < 1.
RankPromise rank_promise(std::vector<double> scores, double false_alarm);

// Whether the rate promised is the rate asked for.
bool promise_kept(double promised, double asked);

// Rank of a score among healthy ones, as a probability: (1 + those at or above it) / (n + 1).
double rank_p_value(double score, const std::vector<double>& healthy);

}  // namespace servodx
