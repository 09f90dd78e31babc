// A log's sweeps: which way the command goes, and an output averaged over small steps of the command, branch by branch.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "curves/curves.h"
#include "servodx/log.h"

namespace servodx::curves {

struct Sweeps {
  std::vector<double> current;         // [A] the command, bridged over missing samples
  std::vector<int> direction;          // +1, -1 at each sample
  std::vector<std::size_t> reversals;  // samples of the command's extremes between branches
  double low = 0, high = 0;            // [A] range
  double rate = 0;                     // [A/s] mean
  double step = 0;                     // [A] of the curves
  double resolution = 0;               // [A] of the command
  bool periodic = false;               // its whole branches take about the same time
  bool both() const { return !reversals.empty(); }
};

// Nothing where the command does not sweep: it jumps, rests, or moves by less than 2 % of rated.
std::optional<Sweeps> sweeps_of(const Log& log, double rated_current);

SweepCurve curve_of(const Sweeps& sweeps, Signal signal, const std::vector<double>& output);

// Least-squares line through the points of x within [low, high]; NaN where there are fewer than three.
struct Line {
  double slope, at_zero;  // [SI of y per SI of x], [SI of y]
};
Line line_through(std::span<const double> x, std::span<const double> y, double low, double high);

// x where the curve first passes `level`, going along x; NaN where it does not.
double crossing(std::span<const double> x, std::span<const double> y, double level);

}  // namespace servodx::curves
