// How much of a held-out misfit one hypothesis removes that another leaves, and how sure that is.
//
// Both are given as the same blocks of time, each block's square from a fit that had not seen it. Residuals are
// correlated, blocks hardly: blocks are drawn with replacement (Kuensch 1989), and the interval is the middle 90 % of
// the draws. With fewer than some ten blocks it is too narrow.
#pragma once
#include <cstdint>
#include <vector>

namespace servodx {

struct Interval {
  double value = 0, lower = 0, upper = 0;
};

// 1 - sum(after) / sum(before), 0 where `before` is none. Pure in its arguments.
Interval heldout_gain(const std::vector<double>& before, const std::vector<double>& after, std::uint64_t seed,
                      int draws);

}  // namespace servodx
