#include "diagnose/fault_fits.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <optional>
#include <utility>

#include "diagnose/constants.h"
#include "diagnose/sub_groups.h"
#include "diagnose/worth_fitting.h"
#include "fit/fit_work.h"

namespace servodx {
namespace {

namespace k = diagnose_constants;

// Near their origin by its derivatives; where it has none, by a few steps of their own.
void approach_all(std::vector<Attempt>& attempts, const HypothesisData& data, const Origin& origin, FitSteps& steps) {
  each_fit(attempts.size(), data, [&](std::size_t i) {
    if (origin.end)
      approach(attempts[i], data, &origin.fit, *origin.end, k::approach_iterations);
    else
      run(attempts[i], data, &origin.fit, k::first_iterations);
    steps.done(FitSteps::approach, attempts[i].work.simulations);
  });
}

// One after another: each sub-group's children fill packs by themselves. The local refinement goes on from the best.
void evolve_all(std::vector<Attempt>& attempts, const HypothesisData& data, const HypothesisFit& health,
                const HypothesisSettings::Genetic& how, FitSteps& steps) {
  for (Attempt& a : attempts) {
    const long before = a.work.simulations;
    through_checkpoint(a, data, "evolve", &health, how.population, [&] { evolve(a, data, health, how); });
    steps.done(0, a.work.simulations - before);
  }
  each_fit(attempts.size(), data, [&](std::size_t i) {
    const long before = attempts[i].work.simulations;
    run(attempts[i], data, &health, k::first_iterations);
    steps.done(FitSteps::approach, attempts[i].work.simulations - before);
  });
}

void run_hopeful(std::vector<Attempt>& attempts, const HypothesisData& data, const HypothesisFit& health,
                 FitSteps& steps) {
  double best = health.misfit;
  for (const Attempt& a : attempts) best = std::min(best, a.fit.misfit);
  each_fit(attempts.size(), data, [&](std::size_t i) {
    const long before = attempts[i].work.simulations;
    const HypothesisFit& fit = attempts[i].fit;
    if (!fit.ok || !is_hopeless(fit.misfit, health.misfit, best, data.degrees))
      run(attempts[i], data, &health, data.settings.iterations);
    steps.done(data.settings.iterations, attempts[i].work.simulations - before);
  });
}

// The likeliest that promise more than another start is worth.
std::vector<std::size_t> unfinished(const std::vector<Attempt>& attempts) {
  std::vector<std::size_t> order(attempts.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return attempts[a].fit.misfit < attempts[b].fit.misfit; });
  order.resize(std::min(order.size(), k::leaders));
  std::erase_if(order, [&](std::size_t i) { return attempts[i].fit.promised <= k::worth_another_start; });
  return order;
}

// A null that moves the spool five times as far on a fifth of a wire takes the usual steps to get halfway: a leader
// that is not there yet leaves much of the log, and a right name would be unknown.
void finish_leaders(std::vector<Attempt>& attempts, const HypothesisData& data, const HypothesisFit& health,
                    int iterations) {
  for (int round = 0; round < k::more_rounds; ++round) {
    const std::vector<std::size_t> open = unfinished(attempts);
    each_fit(open.size(), data, [&](std::size_t i) { run(attempts[open[i]], data, &health, iterations); });
  }
}

// Of each fault the attempt that fits best, with the work of all of them.
std::vector<Attempt> best_of_each(std::vector<Attempt> attempts) {
  std::vector<Attempt> best;
  for (Attempt& a : attempts) {
    if (best.empty() || best.back().fault != a.fault) {
      best.push_back(std::move(a));
      continue;
    }
    Attempt& b = best.back();
    FitWork work = a.work;
    work.add(b.work);
    if (a.fit.ok && a.fit.misfit < b.fit.misfit) b = std::move(a);
    b.work = work;
  }
  return best;
}

// A hypothesis that cannot follow a log bends all that it may on the way.
bool is_bent(const HypothesisFit& fit) {
  const std::vector<double>& left = fit.channel_adequacy;
  return !left.empty() && *std::max_element(left.begin(), left.end()) > k::fault_allowance;
}

}  // namespace

std::vector<Attempt> fit_faults(const Origin& origin, const std::vector<const Fault*>& faults,
                                const std::vector<Screened>& screened, const HypothesisFit& health,
                                const HypothesisData& data, FitSteps& steps) {
  std::vector<Attempt> attempts =
      data.settings.genetic ? starts_of_sides(faults, screened) : best_starts(faults, screened, health, data);
  if (data.settings.genetic)
    evolve_all(attempts, data, health, *data.settings.genetic, steps);
  else
    approach_all(attempts, data, origin, steps);
  attempts = best_of_each(std::move(attempts));
  run_hopeful(attempts, data, health, steps);
  finish_leaders(attempts, data, health, data.settings.iterations);
  return attempts;
}

void fit_faults_from_table(std::vector<Attempt>& attempts, const std::vector<const Fault*>& faults, Attempt& health,
                           const HypothesisData& data, FitSteps& steps) {
  const auto nearer = [](const Attempt& a, const Attempt& b) { return a.fit.misfit < b.fit.misfit; };
  const auto best = std::min_element(attempts.begin(), attempts.end(), nearer);
  if (data.settings.genetic || best == attempts.end() || !is_bent(health.fit) || !is_bent(best->fit)) return;
  Origin table{unfitted(data), {}};
  table.end = end_of(table.fit, data, health.work);
  if (!table.end) return;
  const std::vector<Screened> screened = screen_starts(faults, data, table, steps);
  for (const Screened& s : screened) health.work.add(s.work);
  for (Attempt& other : fit_faults(table, faults, screened, health.fit, data, steps)) {
    const auto same = [&](const Attempt& a) { return a.fault == other.fault; };
    if (const auto it = std::find_if(attempts.begin(), attempts.end(), same); it != attempts.end())
      take_better(*it, std::move(other));
  }
}

}  // namespace servodx
