// The rule of the cause, and whose life counts. No fit, no history.
//
// The cause is the tracked parameter with the most certain trend of those that have surely come at least half as far on
// their way to failure as the furthest (the 5 % quantile of that part: what is read widely comes near by chance, and
// what wears draws the readings of others with it, less certainly), and the life left is its. Where no parameter has
// one, the lives of the paper's checks that have a failure level are pooled, each by its sharpness: what they read
// depends on more than the cause, so beside a cause they only blur it.
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "prognose/life.h"

namespace servodx {

struct CauseEvidence {
  bool tracked = false;    // a parameter with a fault's label
  bool predicted = false;  // a confirmed trend with a life
  double surely = 0;       // part of the way to failure that it has come in 95 of 100 cases
  double log_bayes_factor = 0;
};

// Place of the cause among the checks of a valve.
std::optional<std::size_t> cause_of(const std::vector<CauseEvidence>& checks);

// Lives together, each by the sharpness of its interval; none of none.
Life pooled(const std::vector<const Life*>& lives, double coverage);

}  // namespace servodx
