#include "signals/usual_step.h"

#include <algorithm>
#include <utility>

#include "base/median.h"

namespace servodx {

double usual_step(const std::vector<double>& time) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < time.size(); ++k) steps.push_back(time[k] - time[k - 1]);
  return median(std::move(steps));
}

}  // namespace servodx
