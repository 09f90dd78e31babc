// What one pass over a signal tells of all its samples. The columns of a long log do not stay in the cache, so whatever
// is asked of every sample is asked here, a stretch at a time, as soon as the stretch is in SI.
#pragma once
#include <cstddef>
#include <limits>
#include <span>

namespace servodx {

struct Sweep {
  static constexpr std::size_t stretch = 4096;
  static constexpr double infinite = std::numeric_limits<double>::infinity();

  // Missing samples (NaN) have no part in any of these.
  double low = infinite, high = -infinite;
  double least_step = infinite;  // between neighbours that differ; infinite: none do
  double largest_step = 0.0;     // between neighbours
  double lone = 0.0;             // the farthest that a sample stands off both its neighbours, on one side of them
  std::size_t repeats = 0;       // samples that equal the one before

  // Samples [from, to) of x, which come in order.
  void take(std::span<const double> x, std::size_t from, std::size_t to);
};

// Of all of x.
Sweep sweep_of(std::span<const double> x);

}  // namespace servodx
