#include "diagnose/hypotheses.h"

#include <algorithm>
#include <utility>

#include "diagnose/fault_fits.h"
#include "diagnose/fault_starts.h"
#include "diagnose/fit_steps.h"
#include "diagnose/health_fit.h"
#include "diagnose/hypothesis_fit.h"
#include "diagnose/pair_fits.h"
#include "faults/record.h"

namespace servodx {

std::vector<const Fault*> fitted_faults(const std::vector<const LogData*>& logs) {
  const bool supply_recorded =
      std::none_of(logs.begin(), logs.end(), [](const LogData* log) { return log->scenario.supply_pressure.empty(); });
  std::vector<const Fault*> out;
  for (const Fault* fault : fault_list()) {
    const bool driver = fault->told_by == Record::driver;  // without its record its twin stands for it
    const bool supply = fault->told_by == Record::supply && supply_recorded;
    if (!driver && !supply) out.push_back(fault);
  }
  return out;
}

std::size_t best_fit(const HypothesisFits& fits) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < fits.fits.size(); ++i)
    if (fits.fits[i].misfit < fits.fits[best].misfit) best = i;
  return best;
}

HypothesisFits fit_hypotheses(const std::vector<const LogData*>& logs, const ParameterVector& base,
                              const ErrorModel& error, const HypothesisSettings& settings) {
  const HypothesisData data = hypothesis_data(logs, base, error, settings);
  const std::vector<const Fault*> faults = settings.among.empty() ? fitted_faults(logs) : settings.among;
  FitSteps steps(settings, faults.size());
  HealthFit healthy = fit_health(data, steps);
  Attempt& health = healthy.attempt;
  const Origin as_fitted{health.fit, healthy.end};
  const std::vector<Screened> screened = screen_starts(faults, data, as_fitted, steps);
  std::vector<Attempt> attempts = fit_faults(as_fitted, faults, screened, health.fit, data, steps);
  fit_faults_from_table(attempts, faults, health, data, steps);
  begin_health_again(healthy, attempts, data, steps);

  HypothesisFits out;
  out.degrees = data.degrees;
  out.visible = screened_gains(faults, screened);
  out.healthy_square = std::move(health.square);
  out.work = health.work;
  for (const Screened& s : screened) out.work.add(s.work);
  out.fits.push_back(std::move(health.fit));
  for (Attempt& a : attempts) {
    out.work.add(a.work);
    out.fits.push_back(std::move(a.fit));
  }
  if (settings.pairs) out.pairs = fit_pairs(faults, data, out, out.work);
  return out;
}

}  // namespace servodx
