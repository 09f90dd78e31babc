#include "tune/search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/stopwatch.h"
#include "effects/registry.h"
#include "fit/chart.h"
#include "optimise/ceres_refinement.h"
#include "optimise/derivative_free.h"
#include "optimise/local.h"
#include "optimise/unit_cube.h"
#include "servodx/tune.h"
#include "tune/breadth.h"
#include "tune/constants.h"
#include "tune/kept.h"
#include "tune/summary.h"
#include "tune/tune.h"
#include "tune/weights.h"

namespace servodx {
namespace {

using namespace tune_constants;

// As many points as the other way spends on its Jacobians.
LeastSquaresResult without_derivatives(const FitProblem& problem, const Point& from, Stage stage, int iterations,
                                       Share share, TuneWatch& watch) {
  DerivativeFreeOptions d;
  d.max_evaluations = static_cast<long>(iterations) * (problem.n() + points_beside_columns);
  double first_cost = 0;
  d.progress = [&](long evaluations, double cost) {
    if (evaluations == 1) first_cost = cost;
    watch.tell(share.at(static_cast<double>(evaluations) / static_cast<double>(d.max_evaluations)), problem);
    return !watch.stopped();
  };
  const BatchEvaluate evaluate = [&](std::span<const Point> points) { return problem.evaluate(points); };
  const long before = watch.simulations(problem);
  Stopwatch clock;
  const DerivativeFreeResult found = minimise_without_derivatives(problem.n(), evaluate, from, d);
  LeastSquaresResult end;
  end.point = found.point;
  end.cost = end.misfit = found.cost;
  end.stop = found.stop;
  end.reason = watch.stopped() ? StopReason::interrupted : StopReason::stalled;
  end.promised_gain = std::numeric_limits<double>::infinity();  // nothing says how much is left
  watch.stages.push_back(
      {stage, StageMethod::nlopt, first_cost, found.cost, watch.simulations(problem) - before, 0, clock.lap()});
  return end;
}

LocalMethod method_of(TuneLocal local) {
  return local == TuneLocal::ceres ? LocalMethod::ceres_alone : LocalMethod::search_then_ceres;
}

void tell_stages(TuneWatch& watch, Stage stage, const LocalResult& r) {
  const auto add = [&](StageMethod by, const StageGain& gain) {
    watch.stages.push_back({stage, by, gain.before, gain.after, gain.simulations, gain.jacobians, gain.seconds});
  };
  if (r.search.jacobians > 0) add(StageMethod::least_squares, r.search);
  if (r.ceres.end != CeresEnd::not_run) add(StageMethod::ceres, r.refinement);
  if (r.distrust != Distrust::none) add(StageMethod::nlopt, r.rescue);
  watch.ceres = r.ceres;
  watch.distrust = r.distrust;
}

// How far the best of the generations lies below the first.
void tell_genetic(TuneWatch& watch, double seconds) {
  if (watch.convergence.empty()) return;  // all that is there yet is the genetic search's
  const ConvergencePoint &first = watch.convergence.front(), &last = watch.convergence.back();
  watch.stages.push_back(
      {first.stage, StageMethod::genetic, first.cost, last.cost, last.simulations - first.simulations, 0, seconds});
}

// `runs`: of whole logs, where the last stage ended. Infinite: nothing is held out.
double tell_heldout(TuneWatch& watch, const FitProblem& whole, const std::vector<Trajectory>& runs) {
  const double left = heldout_over_noise(whole, runs, watch.options.heldout);
  if (!watch.stages.empty() && !watch.stopped()) watch.stages.back().heldout_over_noise = left;
  return std::isnan(left) ? std::numeric_limits<double>::infinity() : left;
}

}  // namespace

namespace {

LeastSquaresResult search(const FitProblem& problem, const Point& from, Stage stage, int iterations, Start start,
                          Share share, TuneWatch& watch, Derivatives derivatives) {
  if (watch.options.local == TuneLocal::nlopt)
    return without_derivatives(problem, from, stage, iterations, share, watch);
  LeastSquaresOptions o;
  o.max_iterations = iterations;
  o.difference = Difference::forward;
  o.given_learns = true;
  o.cost_tolerance = start == Start::ended ? ended_tolerance : tells_valleys;
  if (start == Start::ended) o.cost_floor = worth_a_step;
  o.compressed_first_pass = start != Start::ended;
  if (start == Start::found) o.least_metric = o.from_afar;
  o.progress = [&](const LeastSquaresProgress& p) {
    watch.mark(stage, problem, p.cost);
    watch.tell(share.at(static_cast<double>(p.iteration) / iterations), problem);
    return !watch.stopped();
  };
  LocalOptions local;
  local.method = method_of(watch.options.local);
  local.rescue_evaluations = derivatives == Derivatives::on_trial ? rescue_points * problem.n() : 0;
  local.trusted_if_less = tells_valleys;
  local.stop = [&] { return watch.stopped(); };
  local.simulations = [&] { return problem.simulations(); };
  LocalResult r = minimise_locally(problem.least_squares(), from, o, local);
  tell_stages(watch, stage, r);
  return std::move(r.end);
}

template <class T>
std::vector<T> behind(const std::vector<T>& list, std::size_t first) {
  return {list.begin() + static_cast<long>(first), list.end()};
}
template <class T>
void set_behind(std::vector<T>& list, std::size_t first, const std::vector<T>& more) {
  list.resize(first);
  list.insert(list.end(), more.begin(), more.end());
}

}  // namespace

LeastSquaresResult search_locally(const FitProblem& problem, const Point& from, Stage stage, int iterations,
                                  Start start, Share share, TuneWatch& watch, Derivatives derivatives) {
  const auto made = [&] { return search(problem, from, stage, iterations, start, share, watch, derivatives); };
  if (!watch.kept.keeps()) return made();
  const std::size_t points = watch.convergence.size(), stages = watch.stages.size();
  LeastSquaresResult end;
  const auto keep = [&] {
    end = made();
    return KeptSearch{end.point,
                      end.cost,
                      end.misfit,
                      end.promised_gain,
                      end.reason,
                      end.stop,
                      watch.ceres,
                      watch.distrust,
                      behind(watch.convergence, points),
                      behind(watch.stages, stages),
                      {problem.simulations(), problem.failed_simulations()}};
  };
  const KeptSearch kept = watch.kept.made("search", keep, problem.content_hash(), from, stage, iterations, start,
                                          derivatives, watch.work_so_far(problem));
  end.point = kept.point;
  end.cost = kept.cost, end.misfit = kept.misfit, end.promised_gain = kept.promised_gain;
  end.reason = kept.reason, end.stop = kept.stop;
  watch.ceres = kept.ceres, watch.distrust = kept.distrust;
  set_behind(watch.convergence, points, kept.convergence);
  set_behind(watch.stages, stages, kept.stages);
  problem.work() = kept.work;
  watch.tell(share.to, problem);
  return end;
}

// Of twelve starts on four sets of logs eight were in it, and ended within 5 % of each other when they went on; so did
// three of the other four. `--generations 15` of the tutorial, `servodx_foreign --seed 50` and `--seed 52`,
// rig B (docs/accuracy.md).
bool in_best_valley(const LeastSquaresResult& end, double best) {
  const double promised = std::isfinite(end.promised_gain) ? end.promised_gain : 0.0;
  return end.cost - promised <= as_good * best;
}

namespace {

// Of an effect whose numbers go with the size of the rig: a search that begins far from them ends in another valley. A
// table that is tuned has found its own.
std::optional<Point> start_as_large_as_rig(const TuneScope& scope, const Point& nominal) {
  if (scope.table.has_std_error) return {};
  std::optional<Point> out;
  for (const EffectInfo& e : effect_list()) {
    if (!e.as_large_as_rig) continue;
    std::vector<double> own(e.parameters.size());
    e.as_large_as_rig(own.data(), scope.base.data());
    for (std::size_t j = 0; j < scope.shared.size(); ++j) {
      const FreeValue& f = scope.shared[j];
      const int k = f.at - e.first;
      if (k < 0 || k >= static_cast<int>(own.size())) continue;
      if (!out) out = nominal;
      (*out)[j] = f.to_unit(std::clamp(own[static_cast<std::size_t>(k)], f.lower, f.upper));
    }
  }
  return out;
}

struct StartPoint {
  StartEnd::From from;
  Point point;
};

std::vector<StartPoint> start_points(const TuneScope& seen, const Point& nominal, TuneWatch& watch) {
  std::vector<StartPoint> out = {{StartEnd::From::table, nominal}};
  if (std::optional<Point> p = start_as_large_as_rig(seen, nominal))
    out.push_back({StartEnd::From::rig_size, *std::move(p)});
  if (watch.options.generations > 0 && !watch.stopped()) {
    Stopwatch clock;
    for (Point& p : search_broadly(seen, nominal, watch)) out.push_back({StartEnd::From::genetic, std::move(p)});
    tell_genetic(watch, clock.lap());
  }
  return out;
}

}  // namespace

SearchEnds search_ends(const TuneScope& seen, const FitProblem& whole, TuneWatch& watch) {
  FitProblem problem = seen.problem();
  const Point x = problem.start();
  seen.on_stand ? weigh_sweeps(problem, x) : first_whitening(problem, x);
  const std::vector<StartPoint> starts = start_points(seen, x, watch);
  SearchEnds out;
  std::vector<LeastSquaresResult> ends;
  for (std::size_t s = 0; s < starts.size() && !(watch.stopped() && s > 0); ++s) {
    const double begun = static_cast<double>(s), all = static_cast<double>(starts.size());
    ends.push_back(search_locally(problem, starts[s].point, Stage{Stage::Kind::start, static_cast<int>(s) + 1},
                                  iterations_a_start,
                                  starts[s].from == StartEnd::From::genetic ? Start::found : Start::nominal,
                                  {work.starts.at(begun / all), work.starts.at((begun + 1) / all)}, watch));
    const double heldout = tell_heldout(watch, whole, whole.trajectories(ends.back().point));
    out.ends.push_back({{starts[s].from, ends.back().cost}, ends.back().point, heldout});
    if (ends.back().cost < ends[out.best].cost) out.best = s;
  }
  for (std::size_t s = 0; s < ends.size(); ++s)
    out.ends[s].start.in_best_valley = in_best_valley(ends[s], ends[out.best].cost);
  out.end = std::move(ends[out.best]);
  watch.done_with(problem);
  return out;
}

namespace {

enum class Logs { alike, by_their_own_error };

// What the error model takes for error is on the way mostly what the fit has not found yet. Its correlation would leave
// the channel that is furthest off so few samples that it is never mended, so each counts for at least as many as the
// first whitening takes. Its size in one log, beside the others', would do the same to the log that has most to tell:
// before the last rounds logs weigh alike. Only the errors of the values are taken from what is learnt.
// Of a stand's sweeps the residual is one slow curve of the command: by its memory a whole sweep would count for a few
// samples, least where the meter reads finest; by its size beside the speed of the output the flat ends would count,
// and the peak at null not. There weigh_sweeps() holds to the end.
void weigh(FitProblem& problem, const Point& x, ErrorModel& error, bool on_stand, Logs logs) {
  if (on_stand) {
    weigh_sweeps(problem, x);
    return;
  }
  error = learn_error_model(problem, x);
  for (ChannelError& c : error.channels) c.independent = std::max(c.independent, least_independent_rate);
  apply_error_model(problem, error, x, logs == Logs::by_their_own_error);
}

}  // namespace

namespace {

// The best by its cost, then the others, the nearest to what is held out first.
std::vector<const Ended*> in_order_of_trial(const SearchEnds& searched) {
  std::vector<const Ended*> order = {&searched.ends[searched.best]};
  for (std::size_t s = 0; s < searched.ends.size(); ++s)
    if (s != searched.best) order.push_back(&searched.ends[s]);
  std::stable_sort(order.begin() + 1, order.end(),
                   [](const Ended* a, const Ended* b) { return a->heldout < b->heldout; });
  return order;
}

// `left` of the work: how many such fits are to come is not known, so each takes half of it.
SeenFit refine_seen(FitProblem& seen, const FitProblem& whole, const Point& from, bool on_stand, Share& left,
                    TuneWatch& watch) {
  SeenFit out;
  const Share its = {left.from, left.at(0.5)};
  left.from = its.to;
  weigh(seen, from, out.error, on_stand, Logs::alike);
  out.end = search_locally(seen, from, {Stage::Kind::weights}, iterations_of_last_round, Start::ended, its, watch);
  out.whole = whole.trajectories(out.end.point);
  out.heldout = tell_heldout(watch, whole, out.whole);
  return out;
}

// Less than that is chance, and a fit that chance has chosen would flatter the effects that are judged by the same
// part.
bool is_nearer(const SeenFit& a, const SeenFit& b) { return a.heldout < nearer_by * b.heldout; }

}  // namespace

SeenFit refine_best(const SearchEnds& searched, FitProblem& seen, const FitProblem& whole, bool on_stand,
                    TuneWatch& watch) {
  const std::vector<const Ended*> order = in_order_of_trial(searched);
  Share left = work.weights;
  SeenFit best = refine_seen(seen, whole, order.front()->point, on_stand, left, watch);
  for (std::size_t k = 1; k < order.size() && !watch.stopped(); ++k) {
    const double to_beat = k == 1 ? order.front()->heldout : best.heldout;
    if (!(order[k]->heldout < to_beat)) continue;
    SeenFit other = refine_seen(seen, whole, order[k]->point, on_stand, left, watch);
    if (is_nearer(other, best)) best = std::move(other);
  }
  for (bool goes_on = true; goes_on && !watch.stopped();) {
    SeenFit next = refine_seen(seen, whole, best.end.point, on_stand, left, watch);
    goes_on = is_nearer(next, best);
    if (!is_nearer(best, next)) best = std::move(next);
  }
  return best;
}

LeastSquaresResult refine_whole(FitProblem& problem, const Point& from, ErrorModel& error, int rounds, bool on_stand,
                                Share share, TuneWatch& watch) {
  LeastSquaresResult r;
  Point x = from;
  for (int round = 0; round < rounds; ++round) {
    weigh(problem, x, error, on_stand, round == 0 ? Logs::alike : Logs::by_their_own_error);
    const Share of_round = {share.at(static_cast<double>(round) / rounds), share.at((round + 1.0) / rounds)};
    const bool last = round + 1 == rounds;
    // Only the last round's end is kept as it is: there derivatives are judged.
    r = search_locally(problem, x, {Stage::Kind::everything}, last ? iterations_of_last_round : iterations_a_round,
                       Start::ended, of_round, watch, last ? Derivatives::on_trial : Derivatives::trusted);
    x = r.point;
    if (watch.stopped() || (round >= 1 && r.reason == StopReason::converged)) break;
  }
  return r;
}

}  // namespace servodx
