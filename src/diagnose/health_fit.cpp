#include "diagnose/health_fit.h"

#include <algorithm>
#include <span>
#include <utility>

#include "diagnose/constants.h"
#include "diagnose/whitening.h"
#include "evidence/probabilities.h"
#include "fit/problem.h"
#include "optimise/unit_cube.h"

namespace servodx {
namespace {

namespace k = diagnose_constants;

// Health begun elsewhere too, by the derivatives that its end so far left, a run a step. Where that ends lower by more
// than a start is worth, it is fitted on from there: a poor valley of health lends every fault a gain. `from`: what
// each start begins at; null: its own. `own`: the one of them that has derivatives of its own as well; null: none.
void begin_elsewhere(HealthFit& health, std::vector<Attempt> starts, const std::vector<const HypothesisFit*>& from,
                     const HypothesisFit* own, const HypothesisData& data) {
  const double so_far = health.attempt.fit.misfit;
  const double worth = k::worth_another_start * misfit_inflation(so_far, data.degrees);
  Attempt by_own;
  each_fit(starts.size() + (own != nullptr), data, [&](std::size_t i) {
    if (i == starts.size()) return run(by_own, data, own, data.settings.iterations);
    if (health.end) approach(starts[i], data, from[i], *health.end, k::approach_iterations);
    if (!health.end || starts[i].fit.misfit < so_far - worth) run(starts[i], data, from[i], data.settings.iterations);
  });
  for (Attempt& start : starts) take_better(health.attempt, std::move(start));
  if (own) take_better(health.attempt, std::move(by_own));
}

}  // namespace

HealthFit fit_health(const HypothesisData& data, FitSteps& steps) {
  HealthFit health;
  each_fit(1, data, [&](std::size_t) { run(health.attempt, data, nullptr, data.settings.iterations); });
  health.end = end_of(health.attempt.fit, data, health.attempt.work);
  steps.done(data.settings.iterations, health.attempt.work.simulations);
  std::vector<Attempt> around(k::health_starts - 1);
  for (std::size_t i = 0; i < around.size(); ++i) around[i].scattered = static_cast<int>(i) + 1;
  const double usual = health.attempt.fit.misfit;
  const long simulations = health.attempt.work.simulations;
  begin_elsewhere(health, around, std::vector<const HypothesisFit*>(around.size(), nullptr), nullptr, data);
  if (health.attempt.fit.misfit < usual) health.end = end_of(health.attempt.fit, data, health.attempt.work);
  steps.done(FitSteps::around, health.attempt.work.simulations - simulations);
  return health;
}

void begin_health_again(HealthFit& health, const std::vector<Attempt>& faults, const HypothesisData& data,
                        FitSteps& steps) {
  std::vector<const HypothesisFit*> better;
  for (const Attempt& fault : faults)
    if (fault.fit.ok && fault.fit.misfit < health.attempt.fit.misfit - k::worth_another_start)
      better.push_back(&fault.fit);
  if (better.empty()) return;
  const long simulations = health.attempt.work.simulations;
  const HypothesisFit* best =
      *std::min_element(better.begin(), better.end(), [](auto* a, auto* b) { return a->misfit < b->misfit; });
  begin_elsewhere(health, std::vector<Attempt>(better.size()), better, best, data);
  steps.done(FitSteps::again * static_cast<double>(faults.size()), health.attempt.work.simulations - simulations);
}

std::optional<double> healthy_adequacy(const LogData& log, const std::string& name, const ParameterVector& base,
                                       const ErrorModel& error, const HypothesisSettings& settings, FitWork& work) {
  HypothesisSettings of_it = settings;
  of_it.stages = settings.stages.part(name, 0);
  Attempt health;
  run(health, hypothesis_data({&log}, base, error, of_it), nullptr, settings.iterations);
  work.add(health.work);
  const std::vector<double>& adequacy = health.fit.channel_adequacy;
  if (!health.fit.ok || adequacy.empty()) return {};
  return *std::max_element(adequacy.begin(), adequacy.end());
}

std::vector<double> square_beyond_beginning(const LogData& log, std::size_t end, const ParameterVector& base,
                                            const ErrorModel& error, const HypothesisSettings& settings,
                                            FitWork& work) {
  const LogData beginning = slice(log, 0, end);
  HypothesisSettings of_it = settings;
  of_it.stages = settings.stages.part("beginning", end);
  Attempt health;
  run(health, hypothesis_data({&beginning}, base, error, of_it), nullptr, settings.iterations);
  work.add(health.work);
  if (!health.fit.ok) return {};
  FitProblem problem({&log}, base, health.fit.free);
  whiten(problem, 0, error, reference_of(log, base, settings.threads));
  const Evaluation e = problem.evaluate(std::span(&health.fit.point, 1)).front();
  work.add({problem.simulations(), problem.failed_simulations()});
  return e.ok ? squares(problem, e.residual, error) : std::vector<double>{};
}

}  // namespace servodx
