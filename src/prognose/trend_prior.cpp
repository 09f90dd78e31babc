#include "prognose/trend_prior.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "base/median.h"
#include "base/tiny.h"
#include "prognose/check_name.h"
#include "prognose/constants.h"
#include "prognose/failure_level.h"

namespace servodx {

using namespace prognose_constants;

namespace {

// A growth that matters: half as much again for the paper's checks, the way to failure for a parameter.
double way_to(const FailureAt& end, const CheckSeries& s, double base) {
  double scale = s.scale.paper() ? matters_of_paper : std::max(std::abs(base), tiny);
  for (const std::optional<double>& level : {end.lower, end.upper})
    if (level) scale = std::max(std::abs(end.level(*level, base) - base), tiny);
  return scale;
}

int direction_of(const CheckSeries& s, const FailureAt& failure) {
  if (failure.upper && !failure.lower) return 1;
  if (failure.lower && !failure.upper) return -1;
  return s.name.kind() == CheckKind::mean_error ? 1 : 0;
}

// What cold oil does to the estimate of a severity that adds knows nothing of the healthy value.
void add_temperature(GrowthPrior& prior, const CheckSeries& s) {
  const bool adds = s.fault && !s.fault->log_scale;
  const double by_oil = s.scale.paper()
                            ? temperature_swing
                            : temperature_swing * (adds ? prior.scale : std::max(std::abs(prior.base), prior.noise));
  prior.feature_mean = {0.0, 0.0};
  prior.feature_sd = {by_oil, by_oil / 3};
  prior.tilt = oil_in_growth;
  if (!s.scale.paper()) return;
  prior.feature_mean.push_back(1.0);
  prior.feature_sd.push_back(expectation_spread);
}

// A drop begins with all of it.
void take_drop(GrowthPrior& prior) {
  prior.of_drop = true;
  prior.base = 1, prior.base_sd = 1;
  prior.feature_mean = {0.0, 0.0, 1.0};
  prior.feature_sd = {0.0, 0.0, beside_spread};
  prior.tilt = oil_in_drop;
}

}  // namespace

GrowthPrior prior_of(const CheckSeries& s, std::size_t healthy, const FailureAt& failure) {
  std::vector<double> y, error;
  for (std::size_t i = 0; i < healthy; ++i)
    y.push_back(s.points[i].y), error.push_back(std::sqrt(s.points[i].variance));
  GrowthPrior prior;
  prior.base = median(y);
  for (double& v : y) v = std::abs(v - prior.base);
  prior.direction = direction_of(s, failure);
  prior.scale = std::max(way_to(failure, s, prior.base), least_way * way_to(own_failure(s), s, prior.base));
  prior.noise =
      std::max({deviation_per_median * median(y), noise_of_stated * median(error), noise_of_scale * prior.scale});
  prior.base_sd = prior.scale;
  add_temperature(prior, s);
  if (s.scale.of_drop()) take_drop(prior);
  prior.scatter = oil_scatter;
  if (const auto& valves = s.curve.differing()) {
    prior.tilt = std::min(prior.tilt, valves->tilt);
    prior.size_sd = std::min(prior.size_sd, valves->size);
  }
  return prior;
}

}  // namespace servodx
