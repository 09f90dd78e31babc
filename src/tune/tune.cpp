#include "tune/tune.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>

#include "base/error.h"
#include "base/nearest.h"
#include "base/require_setting.h"
#include "base/stopwatch.h"
#include "effects/effect.h"
#include "effects/registry.h"
#include "fit/candidate_of.h"
#include "fit/free_values.h"
#include "fit/log_data.h"
#include "fit/problem.h"
#include "optimise/box_least_squares.h"
#include "optimise/differences.h"
#include "optimise/local.h"
#include "optimise/unit_cube.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "simulate/scenario.h"
#include "tune/constants.h"
#include "tune/earned.h"
#include "tune/kept.h"
#include "tune/named_rows.h"
#include "tune/scope.h"
#include "tune/screen.h"
#include "tune/search.h"
#include "tune/settle.h"
#include "tune/summary.h"
#include "tune/watch.h"

namespace servodx {
namespace {

// The last fit on everything, its residual and derivatives weighed by what was learnt at its end.
LeastSquaresResult weighed_as_learnt(FitProblem& problem, LeastSquaresResult end, ErrorModel& error) {
  error = learn_error_model(problem, end.point);
  apply_error_model(problem, error, end.point);
  const Evaluation at_end = problem.evaluate(std::span(&end.point, 1)).front();
  Eigen::MatrixXd jacobian;
  if (problem.jacobian(end.point, at_end.residual, jacobian)) {
    end.jacobian = jacobian;
  } else if (at_end.ok) {  // column by column; zero where one cannot be had
    const EvaluatePoints evaluate = [&](const std::vector<Point>& points) { return problem.evaluate(points); };
    take_differences(evaluate, end.point, at_end.residual, {}, end.jacobian);
  }
  return end;
}

// The problem that is left is weighed anew.
std::vector<EarnedEffect> drop_unearned(TuneScope& scope, FitProblem& fit, Point& end, const ErrorModel& error,
                                        TuneWatch& watch) {
  apply_error_model(fit, error, end, true);
  Stopwatch clock;
  const long before = watch.simulations(fit);
  std::vector<EarnedEffect> effects = keep_earned(scope, fit, watch.options.heldout, end, watch);
  watch.add_step(Stage::Kind::effects, before, clock, fit);
  watch.done_with(fit);
  fit = scope.problem();
  return effects;
}

// A row of an effect that its held-out part does not need is one that the logs do not tell.
void mark_unearned(std::vector<ScreenedRow>& rows, const std::vector<EarnedEffect>& effects) {
  for (const EffectInfo& e : effect_list())
    if (std::any_of(effects.begin(), effects.end(),
                    [&](const EarnedEffect& t) { return !t.kept && t.effect == e.name; }))
      for (const EffectParameter& p : e.parameters)
        for (ScreenedRow& row : rows)
          if (row.name == p.name && row.verdict == RowVerdict::bounded) row.verdict = RowVerdict::flat;
}

TunedState state_of(const std::vector<Log>& logs, const TuneResult& result, const TuneOptions& options) {
  TunedState state{result.error, {options.moving_average, result.command_slope}, {}, result.unfollowed};
  for (const Log& log : logs)
    state.by.push_back({std::filesystem::path(log.path).filename().string(), log.sha256, content_hash(log)});
  return state;
}

void append(std::vector<Note>& notes, const std::vector<Note>& more) {
  notes.insert(notes.end(), more.begin(), more.end());
}

void require_known(const std::vector<std::string>& effects) {
  std::vector<std::string> known = {"none"};
  for (const EffectInfo& effect : effect_list()) known.push_back(effect.name);
  for (const std::string& name : effects)
    if (std::find(known.begin() + 1, known.end(), name) == known.end())
      throw InputError({.file = "--effects"}, "unknown effect '" + name + "'",
                       did_you_mean(name, known) + fmt::format("use {}, with commas between", fmt::join(known, ", ")));
}

}  // namespace

void TuneOptions::validate() const {
  require_setting(!resume || !checkpoint.empty(), "--resume", "there is nothing to resume from",
                  "add --checkpoint FILE");
  require_setting(!resume || std::filesystem::exists(checkpoint), "--checkpoint",
                  "'" + checkpoint + "' is not there to resume from", "leave out --resume to begin");
  require_setting(population >= 24, "--population", "must be at least 24", "four starts of a healthy valve, six each");
  require_setting(generations >= 0, "--generations", "must not be negative", "0 leaves the genetic search out");
  require_setting(rounds >= 1, "--rounds", "must be at least 1",
                  fmt::format("{} is the default", TuneOptions{}.rounds));
  require_setting(heldout >= 0 && heldout < 1, "--heldout", "is a part of each log, from 0 to below 1",
                  fmt::format("{} is the default", TuneOptions{}.heldout));
  require_setting(moving_average >= 1 && moving_average % 2 == 1, "--moving-average",
                  fmt::format("{} is not an odd number of samples", moving_average), "give 1 for none, or 3, 5, ...");
  require_threads(threads);
  for (const auto& [name, sd] : priors)
    require_setting(sd > 0 && std::isfinite(sd), "--prior", fmt::format("'{}={}' is not NAME=SD", name, sd),
                    "a standard deviation about the table's nominal, above 0, in the table's unit");
  if (effects) require_known(*effects);
  require_row_names(*this);
}

TuneResult tune_table(const std::vector<Log>& logs, const Table& nominal, const RigFile& rig,
                      const TuneOptions& options) {
  options.validate();
  require_profiled_rows(logs, nominal, rig, options);
  TuneWatch watch(options);
  watch.kept = stages_of_tune(logs, nominal, rig, options);
  TuneScope scope = scope_of(logs, nominal, rig, options);
  std::vector<ScreenedRow> screened = screen_rows(scope, watch);
  hold_to_sheet(scope.shared, scope.table, scope.facts, options.priors);

  const TuneScope seen = scope.seen(options.heldout);
  FitProblem fit = scope.problem(), part = seen.problem();
  SearchEnds searched = search_ends(seen, fit, watch);
  LeastSquaresResult end = std::move(searched.end);
  TuneResult out;
  for (const Ended& e : searched.ends) out.starts.push_back(e.start);

  // Weights from the model's own error, alternating with the fit: first with the end of each log still held out. What
  // it says of the fit is out of sample until the effects are judged by it.
  std::vector<Trajectory> heldout_runs;
  if (watch.stopped()) {
    heldout_runs = fit.trajectories(end.point);
  } else {
    SeenFit refined = refine_best(searched, part, fit, scope.on_stand, watch);
    end = std::move(refined.end), out.error = std::move(refined.error), heldout_runs = std::move(refined.whole);
  }
  watch.done_with(part);
  if (!scope.on_stand && !options.effects) out.effects = drop_unearned(scope, fit, end.point, out.error, watch);
  if (!watch.stopped())
    end = refine_whole(fit, end.point, out.error, options.rounds, scope.on_stand, tune_constants::work.whole, watch);
  end = weighed_as_learnt(fit, std::move(end), out.error);

  mark_unearned(screened, out.effects);
  watch.tell(tune_constants::work.whole.to, fit);  // the rows' errors are still to come
  Stopwatch clock;
  const long before = watch.simulations(fit);
  Settled settled = settle(scope, screened, fit, end, watch);
  watch.add_step(Stage::Kind::errors, before, clock, fit);
  out.logs =
      results_by_log(logs, scope, fit, settled.point, fit.trajectories(settled.point), heldout_runs, options.heldout);
  out.channels = pooled_channels(out.logs);
  out.parameters = std::move(settled.parameters);
  out.table = std::move(settled.table);
  take_medians(out.table, out.logs);
  out.command_slope = settled.command_slope;
  out.table.comments = nominal.comments;
  out.unfollowed = unfollowed_channels(out.channels, candidate_of(out.table));
  out.off_drawing = rows_off_drawing(out.table, scope.table, rig);
  set_tuned_state(out.table, state_of(logs, out, options));

  append(out.notes, scope.notes);
  append(out.notes, settled.notes);
  out.notes_by_log = notes_of_logs(out.logs, out.command_slope, scope, rig);
  out.stop = end.reason, out.search_end = end.stop, out.distrust = watch.distrust;
  out.cost = end.cost, out.still_promised = end.promised_gain;
  out.convergence = watch.convergence;
  out.stages = watch.stages;
  out.ceres = watch.ceres;
  out.simulations = watch.simulations(fit);
  out.failed_simulations = watch.failed(fit);
  out.interrupted = watch.stopped();
  return out;
}

}  // namespace servodx
