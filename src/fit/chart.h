// The free numbers of a fit as a chart of its candidates: a point of the unit cube <-> the candidate that a log is run
// with.
//
// Numbers that set one entry go first, then those that move several, in the order they are listed.
#pragma once
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "optimise/unit_cube.h"
#include "parameters/coordinate.h"
#include "simulate/scenario.h"

namespace servodx {

// A free number: which entry of a candidate, and how the unit interval maps onto it.
struct FreeValue : Coordinate {
  int at = 0;    // position in a candidate
  int log = -1;  // index of the log it belongs to, or -1: shared by all
  std::function<void(double* candidate, double value)> apply = {};  // moves several entries at once, in place of `at`

  FreeValue() = default;
  FreeValue(Coordinate number, int position, int of_log = -1)
      : Coordinate(std::move(number)), at(position), log(of_log) {}
  FreeValue(std::string name_of_it, int position, double least, double most, bool in_log, double starts,
            double sd = std::numeric_limits<double>::infinity(), int of_log = -1)
      : FreeValue({std::move(name_of_it), "", least, most, in_log, starts, sd}, position, of_log) {}
};

class Chart {
 public:
  Chart(ParameterVector base, std::vector<FreeValue> free) : base_(std::move(base)), free_(std::move(free)) {}

  int n() const { return static_cast<int>(free_.size()); }
  const std::vector<FreeValue>& free() const { return free_; }
  Point start() const;
  // The candidate of a log at a point.
  ParameterVector candidate(const Point& x, int log) const;
  // Into a candidate that is there: asks for no memory.
  void candidate(const Point& x, int log, ParameterVector& v) const;

 private:
  ParameterVector base_;
  std::vector<FreeValue> free_;
};

}  // namespace servodx
