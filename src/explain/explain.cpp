#include "explain/explain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>

#include "base/error.h"
#include "base/progress.h"
#include "effects/registry.h"
#include "effects/row_effects.h"
#include "explain/replay.h"
#include "explain/score.h"
#include "explain/valve.h"
#include "fit/free_values.h"
#include "parameters/list.h"

namespace servodx {
namespace {

double square_sum(const Eigen::VectorXd& physical, const Series& s) {
  return physical.segment(s.first, s.count).squaredNorm();
}

// The residual of a channel in its own unit, pooled over the logs.
std::vector<ExplainedChannel> channels_of(const ValveSubject& subject, const std::vector<Log>& logs,
                                          const Explanation& e) {
  struct Sum {
    double before = 0, after = 0, noise = 0, held_before = 0, held_after = 0, n = 0;
  };
  std::vector<ExplainedChannel> out;
  std::vector<Sum> sums;
  const Eigen::VectorXd before = subject.physical(e.before.residual), after = subject.physical(e.after.residual);
  for (const Series& s : subject.series()) {
    std::size_t at = 0;
    while (at < out.size() && out[at].signal != s.signal) ++at;
    if (at == out.size()) {
      const Signal signal = *find_signal(s.signal);
      out.push_back({s.signal, logs[static_cast<std::size_t>(s.log)].channels[index(signal)].unit});
      sums.emplace_back();
    }
    Sum& sum = sums[at];
    const auto n = static_cast<double>(s.count);
    sum.n += n;
    sum.noise += n * s.noise * s.noise;
    sum.before += square_sum(before, s);
    sum.after += square_sum(after, s);
    if (e.before.heldout_residual.size() > 0) sum.held_before += square_sum(e.before.heldout_residual, s);
    if (e.after.heldout_residual.size() > 0) sum.held_after += square_sum(e.after.heldout_residual, s);
  }
  for (std::size_t k = 0; k < out.size(); ++k) {
    const auto rms = [&](double v) { return std::sqrt(v / sums[k].n); };
    out[k].rms_before = rms(sums[k].before), out[k].rms_after = rms(sums[k].after),
    out[k].noise_rms = rms(sums[k].noise);
    out[k].heldout_before = rms(sums[k].held_before), out[k].heldout_after = rms(sums[k].held_after);
  }
  return out;
}

std::string name_of(const Cause& c) { return c.effect + (c.where.starts_with("sensor:") ? " at " + c.where : ""); }

// How a number of a cause scatters over healthy logs. [its unit] 0 where that is not known. `of`: what it is a factor
// on.
double healthy_spread(const Subject& subject, const HealthyTest& test, int cause, std::size_t number, double std_error,
                      double of) {
  const Cause& c = subject.causes()[static_cast<std::size_t>(cause)];
  const Number& n = c.numbers[number];
  HealthyScore here{c.effect, c.where + (c.family.empty() ? "" : "/" + c.family), {}, 0, 1, subject.thickness()};
  for (std::size_t a = 0; n.size && a < c.probes.size(); ++a) {
    const auto& probe = c.probes[a].front();
    if (c.probes[a].size() > 1 || probe[number] == n.off) continue;
    const double unit = c.atop.empty() ? std::abs(probe[number] - n.off) : 1 / of;  // as `summarise` counts
    here.sizes.assign(a + 1, {0, std_error / unit});
    return unit * test.spread(here, a);
  }
  return 0;
}

// The error of a number is that of the fit, and what healthy logs scatter.
std::string meaning_of(const Cause& c) {
  if (const int row = find_parameter(c.effect); row >= 0)
    return std::string(parameter_list[static_cast<std::size_t>(row)].meaning);
  for (const RowEffect& e : row_effects())
    if (e.name == c.effect && e.where == c.where) return e.meaning;  // a lag of one sensor is not that of another
  for (const EffectInfo& e : effect_list())
    if (e.name == c.effect) return e.meaning;
  return {};
}

// `told_by`: the subject that it was found on, the valve's or the replay of its blocks.
ExplainedCause described(const ValveSubject& subject, const Subject& told_by, const HealthyTest* test,
                         const CauseResult& r, const ExplainedFit& fit) {
  const Cause& c = subject.causes()[static_cast<std::size_t>(r.cause)];
  ExplainedCause out{
      c.effect,     c.where, c.test, {}, r.heldout_gain, r.beyond_retuning, r.delta_bic, {}, &told_by != &subject,
      meaning_of(c)};
  const auto& values = subject.values(r.cause);
  const auto problem = subject.problem(fit.causes);
  for (std::size_t j = 0; j < c.numbers.size(); ++j) {
    double factor = 1;
    if (values[j].apply && !c.curve)  // a factor on the log's own
      factor = problem->candidate(fit.point, 0)[static_cast<std::size_t>(values[j].at)] / r.value[j];
    const double error =
        std::hypot(r.std_error[j], test ? healthy_spread(told_by, *test, r.cause, j, r.std_error[j], factor) : 0.0);
    out.parameters.push_back(
        {c.numbers[j].name, c.numbers[j].unit, factor * r.value[j], factor * error, factor * c.numbers[j].off});
  }
  for (int other : r.confusable_with)
    out.confusable_with.push_back(name_of(subject.causes()[static_cast<std::size_t>(other)]));
  for (const RowEffect& e : row_effects())
    if (e.name == c.effect && e.where == c.where && e.also) out.confusable_with.push_back(e.also);
  return out;
}

// The tuned table with what was found: re-tuned rows and the causes' own.
Table extended_table(const ValveSubject& subject, const Explanation& e, const std::vector<ExplainedCause>& causes,
                     const std::vector<Log>& logs) {
  Table table = subject.table();
  if (e.causes.empty()) return table;
  const auto problem = subject.problem(e.after.causes);
  const ParameterVector v = problem->candidate(e.after.point, 0);
  for (int i = 0; i < n_parameters; ++i) {
    Row& row = table[i];
    if (row.nominal == v[static_cast<std::size_t>(i)]) continue;
    const bool own = i == row::servovalve_null || i == row::air_fraction;
    if (own && logs.size() > 1) continue;  // belongs to each log
    row.nominal = std::clamp(v[static_cast<std::size_t>(i)], row.lower, row.upper);
    row.source = "explain: re-tuned; before: " + row.source;
  }
  for (std::size_t k = 0; k < causes.size(); ++k) {
    const int c = e.causes[k].cause;
    auto values = subject.values(c);
    auto parameters = causes[k].parameters;
    if (subject.causes()[static_cast<std::size_t>(c)].curve)  // its codes and scale are rows as well
      for (int j = 0; j < 4; ++j) {
        const EffectParameter& p = Unexplained::parameters[j];
        FreeValue code;
        code.name = p.name, code.lower = p.lower, code.upper = p.upper;
        values.push_back(code);
        parameters.push_back(
            {p.name, p.unit, v[static_cast<std::size_t>(effect_row<Unexplained>(j))], std::nan(""), 0});
      }
    for (std::size_t j = 0; j < values.size(); ++j) {
      if (values[j].log > 0) continue;
      int at = table.find(values[j].name);
      if (at < 0) {
        for (const EffectInfo& effect : effect_list())
          for (std::size_t q = 0; q < effect.parameters.size(); ++q)
            if (values[j].name == effect.parameters[q].name) {
              Row row;
              row.name = values[j].name;
              row.group = "effect:" + effect.name;
              row.lower = values[j].lower, row.upper = values[j].upper;
              row.estimate = true;
              row.unit = parameters[j].unit;
              row.description = effect.parameters[q].meaning;
              table.rows.push_back(std::move(row));
              at = static_cast<int>(table.rows.size()) - 1;
            }
      }
      if (at < 0) continue;
      Row& row = table[at];
      row.nominal = std::clamp(parameters[j].value, row.lower, row.upper);
      if (std::isfinite(parameters[j].std_error)) row.std_error = parameters[j].std_error;
      row.source = "explain: " + causes[k].effect;
    }
  }
  return table;
}

// Either, or what does as well in its place, is the other or what does as well in its.
bool share_a_name(const CauseResult& a, const CauseResult& b) {
  const auto names = [](const CauseResult& r) {
    std::vector<int> out = r.confusable_with;
    out.push_back(r.cause);
    return out;
  };
  for (int x : names(a))
    for (int y : names(b))
      if (x == y) return true;
  return false;
}

using Scores = std::vector<std::vector<HealthyScore>>;  // [log][cause]

// Chance that healthy logs score a cause like this: each log by itself, as the healthy ones were taken. All three have
// to outlive it.
std::function<double(const CauseScore&, int)> news(const HealthyTest& test, const Subject& subject,
                                                   const Scores& by_log) {
  return [&](const CauseScore& s, int round) {
    std::vector<HealthyScore> scores;
    const HealthyScore whole = summarise(subject, s);
    if (round == 0)
      for (const auto& log : by_log)
        for (const HealthyScore& h : log)
          if (h.effect == whole.effect && h.where == whole.where) scores.push_back(h);
    if (scores.empty()) scores.push_back(whole);
    return test.together(test.alone(scores));
  };
}

}  // namespace

ExplainResult explain_logs(const std::vector<Log>& logs, const Table& tuned, const RigFile& rig,
                           const HealthyReference* healthy, const ExplainOptions& options) {
  ExplainResult out;
  std::optional<KnownRig> known;
  if (healthy) known = healthy->known();
  ValveSubject subject(logs, tuned, rig, options.threads, known);
  for (std::size_t l = 0; l < logs.size(); ++l) {
    const std::vector<std::string>& notes = subject.logs()[l].notes;
    out.notes.insert(out.notes.end(), notes.begin() + static_cast<long>(logs[l].notes.size()), notes.end());
  }
  Progress progress("explain", {.quiet = options.quiet});
  EngineOptions engine;
  engine.seed = options.seed;
  engine.stop = options.stop;
  engine.level = options.level;
  if (all_on_test_stand(logs, rig)) engine.blocks *= 4;  // a sweep says most in the few seconds that it is near null
  engine.progress = [&](double f) { progress.update(f, subject.simulations()); };
  std::optional<HealthyTest> test;
  // Each log by itself, as the healthy ones were taken; one log is itself.
  std::deque<ValveSubject> single;
  std::vector<ExplainedFit> single_fits;
  Scores alone(logs.size());
  const auto score_alone = [&] {
    for (std::size_t l = 0; l < single.size(); ++l)
      if (single_fits[l].ok)
        for (const CauseScore& s : score_causes(single[l], single_fits[l], engine.among))
          if (!s.probes.empty()) alone[l].push_back(summarise(single[l], s));
  };
  if (healthy) {
    test.emplace(*healthy);
    if (logs.size() > 1)
      for (const Log& log : logs) {
        single.emplace_back(std::vector<Log>{log}, tuned, rig, options.threads, known);
        const std::vector<Curve> of_one = add_curves(single.back());
        single_fits.push_back(fit_base(single.back(), engine.iterations));
        if (single_fits.back().ok) guess_curves(single.back(), of_one, single_fits.back().point);
      }
  }
  if (healthy) {
    engine.p_new = news(*test, subject, alone);
    engine.p_left = [&](const ExplainedFit& fit, int round) {
      std::vector<Miss> misses = subject.misses(fit.residual);
      if (round == 0)  // the blocks do not know of effects
        for (const BlockReplay& b : replay_blocks(subject, fit.point)) misses.push_back({b.block, b.missing});
      return test->any(misses);
    };
  }
  const std::vector<Curve> curves = add_curves(subject);
  const auto curve_of = [&](int cause) {
    return *std::find_if(curves.begin(), curves.end(), [&](const Curve& c) { return c.cause == cause; });
  };
  std::vector<CauseScore> curve_scores;
  const auto named = [&](const Cause& c) {
    return !c.curve && std::find(options.without.begin(), options.without.end(), c.effect) == options.without.end();
  };
  engine.among = named;
  score_alone();
  Explanation e = explain(subject, engine);
  // A name has to leave the logs as healthy ones are left, or to do as well as a curve, which has none. A row without a
  // name of its own, which takes on what the list does not have, has to do better than a curve beyond the interval.
  const auto like_healthy = [&](const Explanation& x) {
    return healthy && test->any(subject.misses(x.after.residual)) > options.level;
  };
  // The first of several alone: a curve is one cause.
  const auto first_fit = [&] {
    if (e.causes.size() == 1) return e.after;
    const int first = e.causes.front().cause;
    ExplainedFit one =
        fit_causes(subject, {first}, &e.before, &e.scores[static_cast<std::size_t>(first)], engine.iterations, false);
    if (one.ok) cross_validate(subject, one, engine.hold_out());
    return one;
  };
  const auto first_alone = [&] {
    return e.causes.size() == 1 ? heldout_gain(e.before, e.after, options.seed).value
                                : e.candidates[static_cast<std::size_t>(e.causes.front().cause)].heldout_gain.value;
  };
  // Left abnormal, by names of which the first removes less than half of it: most of what is wrong has no name, and a
  // heap of names is none.
  const auto left = [&] { return e.causes.empty() ? engine.p_left(e.before, 0) : engine.p_left(e.after, 1); };
  const auto nameless = [&] {
    return healthy && left() <= 0.5 * options.level && (e.causes.empty() || first_alone() < 0.5);
  };
  std::string better_place;
  const bool bare = !e.causes.empty() && subject.causes()[static_cast<std::size_t>(e.causes.front().cause)].prior < 1;
  if (e.before.ok && (e.causes.empty() || bare || (healthy && !like_healthy(e)))) {
    guess_curves(subject, curves, e.before.point);
    engine.among = [](const Cause& c) { return c.curve; };
    engine.most = 1, engine.fitted = engine.judged = 3;
    score_alone();
    Explanation learnt_one = explain(subject, engine, &e);
    curve_scores = learnt_one.scores;
    const auto better_than = [&](const ExplainedFit& name) {
      return !name.ok || (bare ? heldout_gain(learnt_one.after, name, options.seed).lower <= 0
                               : heldout_gain(name, learnt_one.after, options.seed).lower > 0);
    };
    const bool better = !learnt_one.causes.empty() && (e.causes.empty() || better_than(bare ? first_fit() : e.after));
    if (better) {
      for (std::size_t c = 0; c < e.candidates.size(); ++c)
        if (!subject.causes()[c].curve) {
          learnt_one.candidates[c] = e.candidates[c];
          if (e.candidates[c].fate == Fate::taken) learnt_one.candidates[c].fate = Fate::curve_does_better;
        }
      // Names that were refused because they leave the logs abnormal: where the curve does no better, they are as good
      // an answer as it, and where one does better the place is that name's.
      double most = 0;
      for (const ExplainedFit& name : e.refused) {
        const int c = name.causes.back();
        if (heldout_gain(name, learnt_one.after, options.seed).lower > 0) continue;
        learnt_one.causes.front().confusable_with.push_back(c);
        if (const double more = heldout_gain(learnt_one.after, name, options.seed).value; more > most)
          most = more, better_place = subject.causes()[static_cast<std::size_t>(c)].where;
      }
      learnt_one.standing = std::move(e.standing);
      e = std::move(learnt_one);
      const CauseResult& r = e.causes.front();
      out.curve = learnt(curve_of(r.cause), r.value, r.std_error);
    }
  }
  // What the free run leaves open, the replay of the blocks may tell: a name that is news there, is worth its numbers
  // on held-out windows, and leaves the blocks as healthy logs do. Where the free run has a name and others as good, it
  // has to be about one of these.
  std::optional<ReplaySubject> blocks;
  bool by_blocks = false;
  const bool open = e.causes.empty() || out.curve || bare || (healthy && !like_healthy(e) && first_alone() < 0.5);
  if (healthy && e.before.ok && (open || !e.causes.front().confusable_with.empty()))
    blocks.emplace(subject, e.before.point, *known);
  if (blocks && !blocks->empty()) {
    Scores of_blocks(logs.size());
    for (std::size_t l = 0; l < single.size(); ++l)
      if (single_fits[l].ok) of_blocks[l] = score_blocks(single[l], single_fits[l].point, *known).scores;
    EngineOptions there;
    there.seed = options.seed, there.stop = options.stop, there.level = options.level;
    there.among = named;
    there.p_new = news(*test, *blocks, of_blocks);
    // Beside the question of the free run, which has most of its share.
    there.p_left = [&](const ExplainedFit& fit, int) {
      return std::min(1.0, 2 * test->any(blocks->misses(fit.residual)));
    };
    // What was told, held in the free run.
    const auto held = [&](const Explanation& told) {
      ExplainedFit after =
          hold_causes(subject, told.after.causes, numbers_of_causes(*blocks, told.after), e.before, engine.iterations);
      if (after.ok) cross_validate(subject, after, engine.hold_out());
      return after;
    };
    const auto take = [&](Explanation& told, ExplainedFit after) {
      by_blocks = true;
      for (const CauseResult& r : e.causes)
        e.candidates[static_cast<std::size_t>(r.cause)].fate = Fate::blocks_tell_another;
      e.after = std::move(after);
      e.causes = std::move(told.causes);
      for (const CauseResult& r : e.causes)
        e.candidates[static_cast<std::size_t>(r.cause)].fate = Fate::taken_by_blocks;
      out.curve.reset();
      better_place.clear();
    };
    Explanation told = explain(*blocks, there);
    const bool stands = !told.causes.empty() && test->any(blocks->misses(told.after.residual)) > options.level;
    if (stands && (open || share_a_name(told.causes.front(), e.causes.front())))
      if (ExplainedFit after = held(told); after.ok) take(told, std::move(after));
    // Where something is wrong without a name, a curve that they tell serves if the free run finds none, or follows
    // better with it than with its own. A bare row has to do better, as beside the free run's.
    const auto better = [&](const ExplainedFit& after) {
      return heldout_gain(out.curve ? e.after : e.before, after, options.seed).lower > 0 &&
             !(bare && !out.curve && heldout_gain(after, first_fit(), options.seed).lower > 0);
    };
    if (!by_blocks && told.before.ok && (out.curve || bare || nameless())) {
      there.among = [](const Cause& c) { return c.curve; };
      there.most = 1;
      Explanation shape = explain(*blocks, there, &told);
      if (!shape.causes.empty())
        if (ExplainedFit after = held(shape); after.ok && better(after)) {
          const CauseResult r = shape.causes.front();
          take(shape, std::move(after));
          out.curve = learnt(curve_of(r.cause), r.value, r.std_error);
        }
    }
  }
  if (!e.before.ok)
    throw InputError({.file = tuned.path}, "the simulation fails at the table's values on these logs",
                     "check that the table is of this rig");
  out.shown = show(subject, logs, e.before.point);
  out.blocks = replay_blocks(subject, e.before.point);
  if (healthy)
    for (BlockReplay& b : out.blocks) b.p_new = test->miss({b.block, b.missing});
  {
    Progress of_missing("explain, missing input", {.quiet = options.quiet});
    out.missing = missing_inputs(subject, e.before.point, [&](double f) {
      of_missing.update(f, subject.simulations());
      return !options.stop || !options.stop->load();
    });
  }
  for (const CauseScore& s : curve_scores) {
    const Cause& c = subject.causes()[static_cast<std::size_t>(s.cause)];
    if (!c.curve) continue;
    const auto p = healthy ? std::optional<double>(engine.p_new(s, 0)) : std::nullopt;
    auto at =
        std::find_if(out.places.begin(), out.places.end(), [&](const PlaceScore& q) { return q.where == c.where; });
    if (at == out.places.end()) at = out.places.insert(at, {c.where, "", -1, p});
    if (s.gain > at->gain) *at = {c.where, c.family, s.gain, p};
  }
  std::stable_sort(out.places.begin(), out.places.end(), [](const auto& a, const auto& b) { return a.gain > b.gain; });
  for (const CauseResult& r : e.causes) {
    const Subject& told_by = by_blocks ? static_cast<const Subject&>(*blocks) : subject;
    out.causes.push_back(described(subject, told_by, test ? &*test : nullptr, r, e.after));
  }
  for (const CauseResult& r : e.standing) {
    ExplainedFit as;  // a standing cause was fitted alone
    as.causes = {r.cause};
    as.point = subject.problem(as.causes)->start();
    out.standing.push_back(described(subject, subject, test ? &*test : nullptr, r, as));
  }
  for (const CandidateResult& r : e.candidates) {
    const Cause& c = subject.causes()[static_cast<std::size_t>(r.cause)];
    if ((c.curve && !out.curve) || r.fate == Fate::not_looked_at) continue;
    out.candidates.push_back({c.effect, c.where, r.fate, r.predicted_gain,
                              healthy ? std::optional<double>(r.p_new) : std::nullopt, r.fitted, r.heldout_gain,
                              r.delta_bic});
  }
  std::stable_sort(out.candidates.begin(), out.candidates.end(),
                   [](const auto& a, const auto& b) { return a.predicted_gain > b.predicted_gain; });
  out.retuned = e.retuned;
  out.adequacy_before = subject.adequacy(e.before.residual);
  out.adequacy_after = subject.adequacy(e.after.residual);
  if (healthy) out.p_adequacy = left();
  if (!e.causes.empty()) out.heldout_gain = heldout_gain(e.before, e.after, options.seed);
  if (by_blocks && out.heldout_gain.lower <= 0)
    out.notes.push_back(fmt::format(
        "{} is told by the blocks with measured signals between them. The simulation by itself does not follow better "
        "with it: held out it gains {:.0f} % ({:.0f} to {:.0f}).",
        out.causes.front().effect, 100 * out.heldout_gain.value, 100 * out.heldout_gain.lower,
        100 * out.heldout_gain.upper));
  out.verdict = out.curve           ? ExplainVerdict::unexplained
                : !e.causes.empty() ? ExplainVerdict::extended
                                    : ExplainVerdict::sufficient;
  const bool no_name = !out.curve && !by_blocks && nameless();
  if (no_name) out.verdict = ExplainVerdict::unexplained;
  if (no_name && !out.blocks.empty()) {
    const auto least = std::min_element(out.blocks.begin(), out.blocks.end(),
                                        [](const auto& a, const auto& b) { return *a.p_new < *b.p_new; });
    out.where = least->places.front();
    // Where every block looks healthy, the name that helps most knows the place better, though it does not suffice.
    double most = 0;
    for (const ExplainedFit& name : e.refused)
      if (const double gain = heldout_gain(e.before, name, options.seed).value;
          *least->p_new > options.level && gain > most)
        most = gain, out.where = subject.causes()[static_cast<std::size_t>(name.causes.back())].where;
  } else if (!out.causes.empty()) {
    out.where = better_place.empty() ? out.causes.front().where : better_place;
  }
  if (out.curve) out.depends_on = out.curve->depends_on();
  if (no_name)  // no curve does either; what it follows most is said all the same
    for (const PlaceScore& p : out.places)
      if (p.where == out.where) out.depends_on = p.variable;
  out.channels = channels_of(subject, logs, e);
  for (std::size_t l = 0; l < logs.size(); ++l) {
    out.before.push_back(subject.problem({})->candidate(e.before.point, static_cast<int>(l)));
    out.after.push_back(subject.problem(e.after.causes)->candidate(e.after.point, static_cast<int>(l)));
  }
  out.table = extended_table(subject, e, out.causes, logs);
  out.interrupted = options.stop && options.stop->load();
  for (const ValveSubject& one : single)
    out.simulations += one.simulations(), out.failed_simulations += one.failed_simulations();
  out.simulations += subject.simulations();
  out.failed_simulations += subject.failed_simulations();
  return out;
}

}  // namespace servodx
