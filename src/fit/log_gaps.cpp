#include "fit/log_gaps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "base/error.h"
#include "fit/constants.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "signals/usual_step.h"

namespace servodx {

using namespace fit_constants;

std::vector<double> bridged(const std::vector<double>& t, std::vector<double> x) {
  const std::size_t n = x.size();
  std::size_t last = n;  // last present sample
  for (std::size_t k = 0; k < n; ++k) {
    if (std::isnan(x[k])) continue;
    if (last == n) {
      for (std::size_t j = 0; j < k; ++j) x[j] = x[k];
    } else {
      for (std::size_t j = last + 1; j < k; ++j)
        x[j] = x[last] + (x[k] - x[last]) * (t[j] - t[last]) / (t[k] - t[last]);
    }
    last = k;
  }
  if (last < n)
    for (std::size_t j = last + 1; j < n; ++j) x[j] = x[last];
  return x;
}

std::vector<char> after_gaps(const std::vector<double>& t) {
  std::vector<char> unknown(t.size(), 0);
  if (t.size() < 3) return unknown;
  const double usual = usual_step(t);
  double until = -1e300;
  for (std::size_t k = 1; k < t.size(); ++k) {
    const double step = t[k] - t[k - 1];
    if (step > gap_over_step * usual) until = std::max(until, t[k] + std::min(step, gap_memory));
    unknown[k] = t[k] < until;
  }
  return unknown;
}

void refuse_long_gaps(const Log& log, Ports ports) {
  const double longest = ports == Ports::actuator ? longest_gap : longest_wait;
  const std::vector<double>& t = log.time;
  std::size_t first = 0, gaps = 0;
  for (std::size_t k = 1; k < t.size(); ++k)
    if (t[k] - t[k - 1] > longest && gaps++ == 0) first = k;
  if (gaps == 0) return;
  const double step = t[first] - t[first - 1];
  if (2 * gaps >= t.size() - 1)
    throw InputError({.file = log.path, .column = "time"}, fmt::format("its rows are {:.6g} s apart", step),
                     "look at the unit of time: is it in ms or us, and read as s?");
  throw InputError({.file = log.path, .column = "time"},
                   fmt::format("a gap of {:.6g} s between rows {} and {}", step, first, first + 1),
                   "cut the log there: each part is a log of its own");
}

}  // namespace servodx
