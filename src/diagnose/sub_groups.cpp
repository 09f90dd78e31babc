#include "diagnose/sub_groups.h"

#include <span>
#include <utility>
#include <vector>

#include "diagnose/constants.h"
#include "diagnose/severity.h"
#include "fit/problem.h"
#include "optimise/genetic.h"
#include "optimise/genetic_state.h"
#include "optimise/robust_loss.h"
#include "optimise/unit_cube.h"

namespace servodx {
namespace {

namespace k = diagnose_constants;

// The failure mode identifiers: the mode at each of its starting severities on the attempt's side.
std::vector<Point> identifiers(const Attempt& a, const Point& start, const HypothesisData& data) {
  std::vector<Point> out;
  for (const double severity :
       starting_severities(*a.fault, data.base, data.settings.null_limit, data.settings.times_drawing)) {
    if ((severity < 0) != (a.start < 0)) continue;
    out.push_back(start);
    out.back().front() = a.fit.free.front().to_unit(severity);
  }
  return out;
}

}  // namespace

void evolve(Attempt& a, const HypothesisData& data, const HypothesisFit& health,
            const HypothesisSettings::Genetic& how) {
  const std::function<bool()>& stop = data.settings.stop;
  if (stop && stop()) return;
  const FitProblem problem = problem_of(a, data, data.settings.threads);
  const std::vector<Point> seeds = identifiers(a, start_of(a, problem, &health), data);
  GeneticOptions options;
  options.population = how.population;
  options.generations = k::generations;
  options.seed = how.seed;
  options.seed_spread = k::cloud;
  options.archive = 1;
  GeneticHooks hooks;
  hooks.screen = [&](std::span<const Point> points, std::span<const double> bounds) {
    return problem.costs(points, RobustLoss::none, 1.0, true, bounds);
  };
  hooks.generation = [&](const GeneticState&) { return !(stop && stop()); };
  const BatchCost cost = [&](std::span<const Point> points) { return problem.costs(points, RobustLoss::none, 1.0); };
  GeneticResult found = minimise_genetic(problem.n(), cost, options, {seeds}, hooks);
  a.work.add({problem.simulations(), problem.failed_simulations()});
  Individual& best = found.state.best;
  if (best.point.empty() || best.cost >= options.failure_cost) return;
  a.fit.ok = true;
  a.fit.point = std::move(best.point);
  a.fit.misfit = 2 * best.cost;
}

}  // namespace servodx
