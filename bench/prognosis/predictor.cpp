// The predictor alone: the true quantity of random units with noise of a known size in place of a check's reading. What
// it misses here no better reading would mend; what `lives` misses beyond it the readings lack.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/celsius.h"
#include "base/random.h"
#include "prognose/trend.h"
#include "prognose/trend_options.h"
#include "prognose/valve_history.h"
#include "prognosis/metrics.h"
#include "prognosis/study.h"
#include "prognosis/units.h"

namespace servodx::study {
namespace {

// Readings in parts of the way to failure, as a parameter that adds: 0 healthy, 1 failed.
ValveHistory read_with(double noise, const Unit& unit, int checks) {
  Random random(34, unit.stream);
  ValveHistory h;
  h.valve = unit.name;
  for (int k = 0; k < checks; ++k) {
    const double s = 0.95 * k / (checks - 1.0), read = unit.progress(s) + noise * random.normal();
    Recording r;
    r.at = s * unit.life, r.table_sha256 = "-";
    r.temperature = random_condition(random).celsius + zero_celsius;
    r.checks = {{"parameter:9", read, noise, "1", read, 1.0, "feedback_wire_backlash"}};
    h.recordings.push_back(std::move(r));
  }
  return h;
}

}  // namespace

void predictor(int units, int checks) {
  std::vector<Unit> all = plan(0, units);
  // Of the paper's five, as it has always been counted: to a prediction a quantity has no name.
  std::erase_if(all, [](const Unit& u) { return !u.degradation || u.degradation >= degradations + of_the_paper; });
  TrendSettings options;
  options.failure["parameter:9"] = {std::nullopt, 1.0};
  std::printf("%zu lives of %d checks, alpha 0.2; no alert counts as a miss\n%8s %8s %8s %8s %8s %8s\n", all.size(),
              checks, "noise", "lambda", "alerted", "met", "covered", "late");
  for (const double noise : {0.002, 0.005, 0.01, 0.02})
    for (const double lambda : {0.5, 0.7, 0.9}) {
      int alerted = 0, met = 0, covered = 0, late = 0;
      for_each(static_cast<int>(all.size()), "predictor", [&](int i) {
        ValveHistory h = read_with(noise, all[i], checks);
        std::erase_if(h.recordings, [&](const Recording& r) { return r.at > lambda * all[i].life; });
        const double remaining = all[i].life - h.recordings.back().at;
        const ValveTrend t = trend(h, options);
        if (!t.alert_at || !t.remaining) return;
        const bool near = alpha_lambda(t.life, remaining, 0.2), inside = covers(t.life, remaining, 0.9),
                   after = t.remaining->median > remaining;
#pragma omp critical
        ++alerted, met += near, covered += inside, late += after;
      });
      std::printf("%6.1f %% %8.1f %8d %8d %8d %8d\n", 100 * noise, lambda, alerted, met, covered, late);
    }
}

}  // namespace servodx::study
