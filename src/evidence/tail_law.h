// How rarely one more healthy log shows a figure as large, from the figures of a few healthy logs.
//
// A figure is an excess: zero where nothing is wrong, positive else (a gain, a share). Excesses are taken as
// exponential about a mean that is not known; the mean's prior is an inverse gamma that counts as so many logs of a
// usual mean, so that few logs borrow from what is usual. One more excess is then Lomax's (Lomax 1954). That the tail
// is exponential is an assumption, and a rate from it is no promise: evidence/rank_promise.h has that. Whatever the law
// says, what k of n healthy logs show is no rarer than (k + 1) / (n + 1).
#pragma once
#include <vector>

namespace servodx {

struct UsualExcess {
  double mean = 1;  // [as the figures]
  double logs = 1;  // that it counts for
};

class TailLaw {
 public:
  TailLaw(std::vector<double> healthy, UsualExcess usual);
  int logs() const { return static_cast<int>(healthy_.size()); }
  // Chance that one more healthy log shows as much or more; 1 at zero and below.
  double chance(double excess) const;
  // Least excess whose chance by the law is at most `rate`, 0 < rate < 1. The ranks are not asked.
  double excess_at(double rate) const;
  // Healthy logs of the same mean that it takes until the chance of `excess` is at most the rate that they can promise,
  // or `asked` where that is larger, times `share`; 0: as many as there are suffice, -1: no number does.
  int logs_needed(double excess, double asked, double share) const;

 private:
  double by_law(double excess, double sum, double logs) const;
  std::vector<double> healthy_;
  double sum_ = 0;  // of healthy and usual excesses
  double logs_ = 0;
};

// The rate at which a question is asked that has its `share` of all alarms: as rare as asked, where so many logs can
// promise that.
double rate_of_question(double asked, int healthy_logs, double share);

}  // namespace servodx
