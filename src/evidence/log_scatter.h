// How rarely one more healthy log is left as wrong, from how wrong a few healthy logs are left.
//
// A figure is a ratio, positive, 1 where a log is as wrong as usual. Logarithms are taken as normal about a mean that
// is not known; so is their variance, whose prior counts as so many logs of a usual spread. One more logarithm is then
// Student's.
#pragma once
#include <vector>

namespace servodx {

struct UsualSpread {
  double of_logarithm = 1;
  double logs = 0;  // that it counts for; 0: nothing is known beforehand
};

// Student's variable of one more figure beside the healthy ones, and its degrees of freedom.
struct Deviate {
  double t = 0, degrees = 1;
  double chance_above() const;  // 1 below the mean
};
// Figures that are not positive are left out; no deviate (t = 0) of fewer than three, or of a value that is none.
// `error`: of the value's logarithm, one standard deviation, beside what healthy ones scatter by.
Deviate deviate_of(double value, const std::vector<double>& healthy, UsualSpread usual, double error = 0);

}  // namespace servodx
