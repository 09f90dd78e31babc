#include "signals/one_pass.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace servodx {

void Sweep::take(std::span<const double> x, std::size_t from, std::size_t to) {
  // In every comparison NaN is the one that loses.
  for (; from < std::min<std::size_t>(to, 2); ++from) {
    low = x[from] < low ? x[from] : low;
    high = x[from] > high ? x[from] : high;
    if (from == 0) continue;
    const double step = std::abs(x[1] - x[0]);
    least_step = step > 0.0 ? step : infinite;
    largest_step = step > 0.0 ? step : 0.0;
    repeats = step == 0.0;
  }
  double lowest = low, highest = high, least = least_step, largest = largest_step, off = lone, equal = 0.0;
#pragma omp simd reduction(min : lowest, least) reduction(max : highest, largest, off) reduction(+ : equal)
  for (std::size_t i = from; i < to; ++i) {
    const double here = x[i - 1], after = x[i] - here, before = x[i - 2] - here;
    const double step = std::abs(after), farther = std::abs(before);
    const double distance = step > 0.0 ? step : infinite, nearer = step < farther ? step : farther;
    const double stands_off = after * before > 0.0 ? nearer : 0.0;
    lowest = x[i] < lowest ? x[i] : lowest;
    highest = x[i] > highest ? x[i] : highest;
    least = distance < least ? distance : least;
    largest = step > largest ? step : largest;
    off = stands_off > off ? stands_off : off;
    equal += step == 0.0 ? 1.0 : 0.0;
  }
  // Reductions begin at infinity with g++ and at the largest double with clang: where nothing was found, it is
  // infinity.
  constexpr double most = std::numeric_limits<double>::max();
  low = lowest < most ? lowest : infinite;
  high = highest > -most ? highest : -infinite;
  least_step = least < most ? least : infinite;
  largest_step = largest;
  lone = off;
  repeats += static_cast<std::size_t>(equal);
}

Sweep sweep_of(std::span<const double> x) {
  Sweep sweep;
  for (std::size_t from = 0, to; from < x.size(); from = to)
    sweep.take(x, from, to = std::min(x.size(), from + Sweep::stretch));
  return sweep;
}

}  // namespace servodx
