#include "tune/breadth.h"

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "base/stages.h"
#include "fit/chart.h"
#include "fit/fit_work.h"
#include "fit/log_data.h"
#include "fit/problem.h"
#include "optimise/genetic.h"
#include "optimise/genetic_state.h"
#include "optimise/robust_loss.h"
#include "parameters/list.h"
#include "servodx/error.h"
#include "servodx/rig.h"
#include "servodx/tune.h"
#include "tune/constants.h"
#include "tune/kept.h"
#include "tune/tune.h"
#include "tune/weights.h"

namespace servodx {
namespace {

using namespace tune_constants;

// Costs of points in the shared values alone, the nuisances held where the search begins.
class BroadCosts {
 public:
  BroadCosts(const FitProblem& problem, Point start) : problem_(problem), start_(std::move(start)) {}

  // Compressed residuals: one channel far off must not hide the rest.
  std::vector<double> operator()(std::span<const Point> points, bool ranking, std::span<const double> bounds) {
    if (whole_.size() < points.size()) whole_.resize(points.size(), start_);
    for (std::size_t k = 0; k < points.size(); ++k) std::copy(points[k].begin(), points[k].end(), whole_[k].begin());
    return problem_.costs(std::span(whole_).first(points.size()), RobustLoss::compressed, compression_scale, ranking,
                          bounds);
  }
  Point full(const Point& shared) const {
    Point x = start_;
    std::copy(shared.begin(), shared.end(), x.begin());
    return x;
  }

 private:
  const FitProblem& problem_;
  Point start_;
  std::vector<Point> whole_;  // kept: a generation asks for no memory
};

// Starts of a healthy valve, an island each: as the table says; a slow first stage; much friction; wide edges. What
// fails is no part of a tune; sub-groups with a failure mode identifier each are diagnose's (diagnose/sub_groups.h).
std::vector<std::vector<Point>> healthy_starts(const std::vector<FreeValue>& shared, const Point& start) {
  const std::size_t n = shared.size();
  const Point nominal(start.begin(), start.begin() + static_cast<long>(n));
  const auto moved = [&](std::initializer_list<std::pair<int, double>> moves) {
    Point p = nominal;
    for (std::size_t j = 0; j < n; ++j)
      for (const auto& [at, factor] : moves)
        if (shared[j].at == at) p[j] = shared[j].to_unit(shared[j].from_unit(p[j]) * factor);
    return p;
  };
  return {
      {nominal},
      {moved({{row::driver_bandwidth, island::driver_bandwidth},
              {row::torque_motor_frequency, island::torque_motor_frequency},
              {row::fixed_orifice_diameter, island::orifice_diameter}})},
      {moved({{row::spool_friction, island::spool_friction}, {row::piston_coulomb_friction, island::piston_friction}})},
      {moved({{row::radial_clearance, island::clearance}, {row::hydraulic_amplifier_gain, island::amplifier_gain}})}};
}

// The generations of one search, as a checkpoint keeps them.
class KeptGenerations {
 public:
  KeptGenerations(const TuneWatch& watch, const FitProblem& problem, const Point& start, const GeneticOptions& options)
      : watch_(watch), problem_(problem), options_(options) {
    if (watch.kept.keeps())
      stages_ = watch.kept.part("generations", problem.content_hash(), start, options.population, options.seed,
                                watch.work_so_far(problem));
  }

  void keep(const GeneticState& state, const std::vector<ConvergencePoint>& convergence) const {
    if (!stages_.keeps()) return;
    const FitWork work = problem_.work();
    stages_.keep(key(state.generation), KeptGeneration{to_json(state), convergence, work});
  }

  std::optional<KeptGeneration> last() const {
    for (int g = options_.generations; stages_.keeps() && !watch_.stopped() && g >= 0; --g)
      if (auto kept = stages_.find<KeptGeneration>(key(g))) return kept;
    return {};
  }

 private:
  // A search's last wave ends with its last generation: what that leaves is no part of a longer search.
  std::string key(int generation) const {
    return stages_.key("generation", generation, generation == options_.generations);
  }
  const TuneWatch& watch_;
  const FitProblem& problem_;
  const GeneticOptions& options_;
  Stages stages_;
};

}  // namespace

std::vector<Point> search_broadly(const TuneScope& whole, const Point& start, TuneWatch& watch) {
  const TuneScope scope = whole.first_seconds(excerpt);
  FitProblem problem = scope.problem();
  first_whitening(problem, start);
  BroadCosts costs(problem, start);
  const TuneOptions& options = watch.options;
  GeneticOptions o;
  o.population = options.population;
  o.generations = options.generations;
  o.seed = options.seed;
  o.archive = kept_points;
  const BatchCost cost = [&](std::span<const Point> points) { return costs(points, false, {}); };
  GeneticHooks hooks;
  hooks.screen = [&](std::span<const Point> points, std::span<const double> bounds) {
    return costs(points, true, bounds);
  };
  const KeptGenerations generations(watch, problem, start, o);
  hooks.generation = [&](const GeneticState& s) {
    if (!s.best.point.empty() && (s.generation % shown_every == 0 || s.generation == o.generations))
      watch.convergence.push_back(
          {Stage{Stage::Kind::genetic}, watch.simulations(problem), cost(std::span(&s.best.point, 1)).front()});
    generations.keep(s, watch.convergence);
    watch.tell(work.genetic.at(static_cast<double>(s.generation) / o.generations), problem);
    return !watch.stopped();
  };
  std::optional<GeneticState> saved;
  if (std::optional<KeptGeneration> kept = generations.last()) {
    saved = genetic_state_from_json(kept->state);
    watch.convergence = std::move(kept->convergence);
    problem.work() = kept->work;
  }
  const GeneticResult found = minimise_genetic(static_cast<int>(scope.shared.size()), cost, o,
                                               healthy_starts(scope.shared, start), hooks, saved ? &*saved : nullptr);
  watch.done_with(problem);
  std::vector<Point> out;
  for (const Individual& i : found.state.archive) out.push_back(costs.full(i.point));
  if (out.empty()) out.push_back(costs.full(found.state.best.point));
  return out;
}

}  // namespace servodx
