// A life left: equally likely hours until something has failed, and what is read off them.
#pragma once
#include <utility>
#include <vector>

namespace servodx {

// Sorted hours from now on to the passing of a level, each as likely as the other; infinite where it is never passed.
using Life = std::vector<double>;

double life_quantile(const Life& life, double p);

struct Remaining {
  double median = 0, lower = 0, upper = 0;  // [h]; infinite where never
};
Remaining remaining_of(const Life& life, double coverage);

// Weighted hours, sorted, as equally likely ones. `total`: of the weights.
Life equally_likely(const std::vector<std::pair<double, double>>& weighted, double total);

}  // namespace servodx
