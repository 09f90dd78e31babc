// Excesses of healthy logs that follow a condition of theirs, such as the oil's viscosity.
//
// A model that misses what cold oil does misses it in every cold log. One such log among ten says little about a
// suspect in warm oil, and much about one in cold oil. So the mean of an exponential excess is taken to grow by a
// constant factor a unit of the condition, exp(slope (at - middle)), where that is worth its number (Schwarz 1978). The
// slope has a prior, as few logs tell it badly.
#pragma once
#include <vector>

namespace servodx {

struct ExcessAt {
  double excess;
  double at;  // condition; NaN: not known
};

class ExcessTrend {
 public:
  explicit ExcessTrend(const std::vector<ExcessAt>& healthy);
  double slope() const { return slope_; }
  // Mean excess there over that of all healthy logs. No log speaks beyond the outermost: it is level there. 1 where the
  // condition is not known.
  double scale(double at) const;

 private:
  double slope_ = 0, middle_ = 0, least_ = 0, most_ = 0, mean_ = 1;
};

}  // namespace servodx
