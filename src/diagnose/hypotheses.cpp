#include "diagnose/hypotheses.h"

#include <algorithm>
#include <atomic>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <span>

#include "diagnose/constants.h"
#include "diagnose/hypothesis_fit.h"
#include "diagnose/kept.h"
#include "diagnose/severity.h"
#include "diagnose/sub_groups.h"
#include "diagnose/whitening.h"
#include "diagnose/worth_fitting.h"
#include "evidence/probabilities.h"
#include "faults/record.h"
#include "simulate/together.h"

namespace servodx {
namespace {

namespace k = diagnose_constants;

// Progress, counted in steps of least squares: a screening is about one, and few begin again.
class Steps {
 public:
  static constexpr double screening = 1, approach = 1, again = 1;  // a fault
  static constexpr double around = 2;                              // all starts of health but the first

  Steps(const HypothesisSettings& settings, std::size_t faults)
      : settings_(settings),
        whole_(settings.iterations + around +
               static_cast<double>(faults) * (screening + k::starts_kept * approach + settings.iterations + again)) {}
  void done(double steps, long simulations) {
    const double so_far = done_.fetch_add(steps) + steps;
    const long all = simulated_.fetch_add(simulations) + simulations;
    if (settings_.progress) settings_.progress(std::min(1.0, so_far / whole_), all);
  }

 private:
  const HypothesisSettings& settings_;
  double whole_;
  std::atomic<double> done_ = 0;
  std::atomic<long> simulated_ = 0;
};

struct Health {
  Attempt attempt;
  std::optional<FitEnd> end;  // none where the fit failed
};

void side_by_side(std::size_t count, const HypothesisData& data, const std::function<void(std::size_t)>& task) {
  std::size_t samples = 0;
  for (const LogData* log : data.logs) samples += log->scenario.time.size();
  fits_together(static_cast<int>(count), samples, data.settings.threads,
                [&](int i) { task(static_cast<std::size_t>(i)); });
}

// What a fault's other numbers begin at: health as it was fitted, or as the table has it.
struct Origin {
  HypothesisFit fit;
  std::optional<FitEnd> end;  // none where that fit failed
};

// Every starting severity of every fault, run once with the rest as in its origin; the best first.
std::vector<Screened> screen_starts(const std::vector<const Fault*>& faults, const HypothesisData& data,
                                    const Origin& origin, Steps& steps) {
  std::vector<Screened> screened;
  for (const Fault* fault : faults)
    for (double severity :
         starting_severities(*fault, data.base, data.settings.null_limit, data.settings.times_drawing))
      screened.push_back({fault, severity});
  const auto run_all = [&] {
    side_by_side(screened.size(), data, [&](std::size_t i) {
      screen(screened[i], data, origin.fit, origin.end ? &*origin.end : nullptr);
      steps.done(Steps::screening * static_cast<double>(faults.size()) / static_cast<double>(screened.size()),
                 screened[i].work.simulations);
    });
    return screened;
  };
  screened = data.settings.stages.made("screen", run_all, screened, origin.fit, origin.end.has_value());
  std::stable_sort(screened.begin(), screened.end(),
                   [](const Screened& a, const Screened& b) { return a.left < b.left; });
  return screened;
}

// What the screened severities would have gained, the mildest first; of a fault with two sides each by itself.
std::vector<VisibleFault> visible_of(const std::vector<const Fault*>& faults, const std::vector<Screened>& screened) {
  std::vector<VisibleFault> out;
  for (const Fault* fault : faults)
    for (const bool negative : {false, true}) {
      VisibleFault side{fault, {}};
      for (const Screened& s : screened)
        if (s.fault == fault && (s.severity < 0) == negative && s.gain >= 0) side.gains.push_back({s.severity, s.gain});
      const auto size = [&](const SeverityGain& g) { return std::abs(g.severity - fault->healthy); };
      std::stable_sort(side.gains.begin(), side.gains.end(),
                       [&](const SeverityGain& a, const SeverityGain& b) { return size(a) < size(b); });
      if (!side.gains.empty()) out.push_back(std::move(side));
    }
  return out;
}

// Of each fault the starts that screened best: one, and those that the linear model does not put hopelessly behind it.
std::vector<Attempt> best_starts(const std::vector<const Fault*>& faults, const std::vector<Screened>& screened,
                                 const HypothesisFit& health, const HypothesisData& data) {
  const double behind = k::hopeless * misfit_inflation(health.misfit, data.degrees);
  std::vector<Attempt> attempts;
  for (const Fault* fault : faults) {
    int begun = 0;
    double best = 0;
    for (const Screened& s : screened) {
      if (s.fault != fault || begun == k::starts_kept || (begun > 0 && !(s.left < best + behind))) continue;
      if (begun == 0) best = s.left;
      attempts.push_back({fault, s.severity}), ++begun;
    }
  }
  return attempts;
}

// Near their origin by its derivatives; where it has none, by a few steps of their own.
void approach_all(std::vector<Attempt>& attempts, const HypothesisData& data, const Origin& origin, Steps& steps) {
  side_by_side(attempts.size(), data, [&](std::size_t i) {
    if (origin.end)
      approach(attempts[i], data, &origin.fit, *origin.end, k::approach_iterations);
    else
      run(attempts[i], data, &origin.fit, k::first_iterations);
    steps.done(Steps::approach, attempts[i].work.simulations);
  });
}

// Each side of each fault, the failure modes that sub-groups are made of, beginning where it screened best.
std::vector<Attempt> sub_groups(const std::vector<const Fault*>& faults, const std::vector<Screened>& screened) {
  std::vector<Attempt> attempts;
  for (const Fault* fault : faults)
    for (const bool negative : {false, true}) {
      const auto best = std::find_if(screened.begin(), screened.end(), [&](const Screened& s) {
        return s.fault == fault && (s.severity < 0) == negative;
      });
      if (best != screened.end()) attempts.push_back({fault, best->severity});
    }
  return attempts;
}

// One after another: each sub-group's children fill packs by themselves. The local refinement goes on from the best.
void evolve_all(std::vector<Attempt>& attempts, const HypothesisData& data, const HypothesisFit& health,
                const HypothesisSettings::Genetic& how, Steps& steps) {
  for (Attempt& a : attempts) {
    const long before = a.work.simulations;
    through_checkpoint(a, data, "evolve", &health, how.population, [&] { evolve(a, data, health, how); });
    steps.done(0, a.work.simulations - before);
  }
  side_by_side(attempts.size(), data, [&](std::size_t i) {
    const long before = attempts[i].work.simulations;
    run(attempts[i], data, &health, k::first_iterations);
    steps.done(Steps::approach, attempts[i].work.simulations - before);
  });
}

void run_hopeful(std::vector<Attempt>& attempts, const HypothesisData& data, const HypothesisFit& health,
                 Steps& steps) {
  double best = health.misfit;
  for (const Attempt& a : attempts) best = std::min(best, a.fit.misfit);
  side_by_side(attempts.size(), data, [&](std::size_t i) {
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
    side_by_side(open.size(), data, [&](std::size_t i) { run(attempts[open[i]], data, &health, iterations); });
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

// The better of an attempt and of one begun elsewhere, with the work of both.
void take_better(Attempt& attempt, Attempt other) {
  FitWork work = attempt.work;
  work.add(other.work);
  if (other.fit.ok && other.fit.misfit < attempt.fit.misfit) attempt = std::move(other);
  attempt.work = work;
}

// Health begun elsewhere too, by the derivatives that its end so far left, a run a step. Where that ends lower by more
// than a start is worth, it is fitted on from there: a poor valley of health lends every fault a gain. `from`: what
// each start begins at; null: its own. `own`: the one of them that has derivatives of its own as well; null: none.
void begin_elsewhere(Health& health, std::vector<Attempt> starts, const std::vector<const HypothesisFit*>& from,
                     const HypothesisFit* own, const HypothesisData& data) {
  const double so_far = health.attempt.fit.misfit;
  const double worth = k::worth_another_start * misfit_inflation(so_far, data.degrees);
  Attempt by_own;
  side_by_side(starts.size() + (own != nullptr), data, [&](std::size_t i) {
    if (i == starts.size()) return run(by_own, data, own, data.settings.iterations);
    if (health.end) approach(starts[i], data, from[i], *health.end, k::approach_iterations);
    if (!health.end || starts[i].fit.misfit < so_far - worth) run(starts[i], data, from[i], data.settings.iterations);
  });
  for (Attempt& start : starts) take_better(health.attempt, std::move(start));
  if (own) take_better(health.attempt, std::move(by_own));
}

// From its usual start, then from others around it.
Health fit_health(const HypothesisData& data, Steps& steps) {
  Health health;
  side_by_side(1, data, [&](std::size_t) { run(health.attempt, data, nullptr, data.settings.iterations); });
  health.end = end_of(health.attempt.fit, data, health.attempt.work);
  steps.done(data.settings.iterations, health.attempt.work.simulations);
  std::vector<Attempt> around(k::health_starts - 1);
  for (std::size_t i = 0; i < around.size(); ++i) around[i].scattered = static_cast<int>(i) + 1;
  const double usual = health.attempt.fit.misfit;
  const long simulations = health.attempt.work.simulations;
  begin_elsewhere(health, around, std::vector<const HypothesisFit*>(around.size(), nullptr), nullptr, data);
  if (health.attempt.fit.misfit < usual) health.end = end_of(health.attempt.fit, data, health.attempt.work);
  steps.done(Steps::around, health.attempt.work.simulations - simulations);
  return health;
}

// Health had few starts, the faults many: what one of them gained by better nuisances is no fault's. So health begins
// again where each fault ended, and where the best one did by derivatives of its own: its gain decides.
void begin_health_again(Health& health, const std::vector<Attempt>& faults, const HypothesisData& data, Steps& steps) {
  std::vector<const HypothesisFit*> better;
  for (const Attempt& fault : faults)
    if (fault.fit.ok && fault.fit.misfit < health.attempt.fit.misfit - k::worth_another_start)
      better.push_back(&fault.fit);
  if (better.empty()) return;
  const long simulations = health.attempt.work.simulations;
  const HypothesisFit* best =
      *std::min_element(better.begin(), better.end(), [](auto* a, auto* b) { return a->misfit < b->misfit; });
  begin_elsewhere(health, std::vector<Attempt>(better.size()), better, best, data);
  steps.done(Steps::again * static_cast<double>(faults.size()), health.attempt.work.simulations - simulations);
}

// The fit of each fault from an origin, in the order of the list.
std::vector<Attempt> fit_from(const Origin& origin, const std::vector<const Fault*>& faults,
                              const std::vector<Screened>& screened, const HypothesisFit& health,
                              const HypothesisData& data, Steps& steps) {
  std::vector<Attempt> attempts =
      data.settings.genetic ? sub_groups(faults, screened) : best_starts(faults, screened, health, data);
  if (data.settings.genetic)
    evolve_all(attempts, data, health, *data.settings.genetic, steps);
  else
    approach_all(attempts, data, origin, steps);
  attempts = best_of_each(std::move(attempts));
  run_hopeful(attempts, data, health, steps);
  finish_leaders(attempts, data, health, data.settings.iterations);
  return attempts;
}

// A hypothesis that cannot follow a log bends all that it may on the way.
bool is_bent(const HypothesisFit& fit) {
  const std::vector<double>& left = fit.channel_adequacy;
  return !left.empty() && *std::max_element(left.begin(), left.end()) > k::fault_allowance;
}

// A fault that begins where bent health ended may stay in that valley. Where none leaves the log as a fault may, each
// is fitted from the table's values too.
void begin_at_table(std::vector<Attempt>& attempts, const std::vector<const Fault*>& faults, Attempt& health,
                    const HypothesisData& data, Steps& steps) {
  const auto nearer = [](const Attempt& a, const Attempt& b) { return a.fit.misfit < b.fit.misfit; };
  const auto best = std::min_element(attempts.begin(), attempts.end(), nearer);
  if (data.settings.genetic || best == attempts.end() || !is_bent(health.fit) || !is_bent(best->fit)) return;
  Origin table{unfitted(data), {}};
  table.end = end_of(table.fit, data, health.work);
  if (!table.end) return;
  const std::vector<Screened> screened = screen_starts(faults, data, table, steps);
  for (const Screened& s : screened) health.work.add(s.work);
  for (Attempt& other : fit_from(table, faults, screened, health.fit, data, steps)) {
    const auto same = [&](const Attempt& a) { return a.fault == other.fault; };
    if (const auto it = std::find_if(attempts.begin(), attempts.end(), same); it != attempts.end())
      take_better(*it, std::move(other));
  }
}

// The single faults that a second one is tried beside: the likeliest, where each gains beyond doubt.
std::vector<const HypothesisFit*> leading(const HypothesisFits& fits) {
  std::vector<const HypothesisFit*> out;
  const double inflation = misfit_inflation(fits.fits[best_fit(fits)].misfit, fits.degrees);
  for (std::size_t i = 1; i < fits.fits.size(); ++i)
    if (fits.fits[i].ok && fits.fits.front().misfit - fits.fits[i].misfit > k::worth_a_pair * inflation)
      out.push_back(&fits.fits[i]);
  std::stable_sort(out.begin(), out.end(), [](const auto* a, const auto* b) { return a->misfit < b->misfit; });
  if (out.size() > k::pair_leaders) out.resize(k::pair_leaders);
  return out;
}

// A fault that others are tried beside.
struct Leader {
  const HypothesisFit* fit;
  std::optional<FitEnd> end;
};

// A leading fault and another one beside it.
struct PairStart {
  const Leader* leader;
  Attempt attempt;
};

// Each other fault beside a leading one, at each of its starts. Two that no log parts are one.
std::vector<Screened> screen_pairs(const std::vector<const Fault*>& faults, const std::vector<Leader>& leaders,
                                   const HypothesisData& data, std::vector<const Leader*>& of) {
  std::vector<Screened> screened;
  for (const Leader& leader : leaders)
    for (const Fault* fault : faults) {
      const bool tried = fault == leader.fit->fault || (&leader != &leaders[0] && fault == leaders[0].fit->fault);
      if (tried || are_twins(*fault, *leader.fit->fault)) continue;
      for (const double severity :
           starting_severities(*fault, data.base, data.settings.null_limit, data.settings.times_drawing))
        screened.push_back({.fault = leader.fit->fault, .severity = severity, .beside = fault}), of.push_back(&leader);
    }
  const auto run_all = [&] {
    side_by_side(screened.size(), data,
                 [&](std::size_t i) { screen(screened[i], data, *of[i]->fit, of[i]->end ? &*of[i]->end : nullptr); });
    return screened;
  };
  std::vector<HypothesisFit> beside;
  for (const Leader& leader : leaders) beside.push_back(*leader.fit);
  return data.settings.stages.made("screen pairs", run_all, screened, beside);
}

// What a fit is expected to gain by a screened fault of the size that suits the log best, in proportion to the
// screened size; endless where no linear model says so.
double promised_gain(const Screened& screened, const Leader& leader) {
  if (!leader.end || screened.gain < 0) return std::numeric_limits<double>::infinity();
  const double alone = leader.fit->misfit - leader.end->answer.taken(leader.end->gradient);
  const double slope = (alone + screened.gain - screened.left) / 2;  // minus half the misfit's, by the size
  return slope > 0 && screened.gain > 0 ? slope * slope / screened.gain : 0;
}

// Of each pair that promises more than chance lends a second fault, the start that screens best.
std::vector<PairStart> pair_starts(const std::vector<const Fault*>& faults, const std::vector<Leader>& leaders,
                                   const HypothesisData& data, FitWork& work) {
  std::vector<const Leader*> of;
  const std::vector<Screened> screened = screen_pairs(faults, leaders, data, of);
  std::vector<PairStart> out;
  for (std::size_t first = 0, last; first < screened.size(); first = last) {
    const Screened* best = &screened[first];
    double promised = 0;
    for (last = first; last < screened.size() && of[last] == of[first] && screened[last].beside == best->beside;
         ++last) {
      work.add(screened[last].work);
      promised = std::max(promised, promised_gain(screened[last], *of[first]));
      if (screened[last].misfit < best->misfit) best = &screened[last];
    }
    const HypothesisFit& lead = *of[first]->fit;
    if (promised > k::worth_another_start * misfit_inflation(lead.misfit, data.degrees))
      out.push_back({of[first], {best->fault, lead.severity, best->beside, best->severity}});
  }
  return out;
}

// Of all pairs those that came nearest are fitted by derivatives of their own.
void fit_pairs(const std::vector<const Fault*>& faults, const HypothesisData& data, HypothesisFits& fits) {
  if (!pair_could_gain(fits.fits[best_fit(fits)].misfit, fits.fits.front().misfit)) return;
  std::vector<Leader> leaders;
  for (const HypothesisFit* fit : leading(fits)) leaders.push_back({fit, end_of(*fit, data, fits.work)});
  std::vector<PairStart> pairs = pair_starts(faults, leaders, data, fits.work);
  side_by_side(pairs.size(), data, [&](std::size_t i) {
    const Leader& leader = *pairs[i].leader;
    if (leader.end) approach(pairs[i].attempt, data, leader.fit, *leader.end, k::approach_iterations);
  });
  const auto nearer = [](auto& a, auto& b) { return a.attempt.fit.misfit < b.attempt.fit.misfit; };
  std::stable_sort(pairs.begin(), pairs.end(), nearer);
  side_by_side(std::min(k::pair_finalists, pairs.size()), data,
               [&](std::size_t i) { run(pairs[i].attempt, data, nullptr, data.settings.iterations); });
  for (PairStart& pair : pairs) {
    fits.work.add(pair.attempt.work);
    if (pair.attempt.fit.ok) fits.pairs.push_back(std::move(pair.attempt.fit));
  }
}

}  // namespace

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
  Steps steps(settings, faults.size());
  Health healthy = fit_health(data, steps);
  Attempt& health = healthy.attempt;
  const Origin as_fitted{health.fit, healthy.end};
  const std::vector<Screened> screened = screen_starts(faults, data, as_fitted, steps);
  std::vector<Attempt> attempts = fit_from(as_fitted, faults, screened, health.fit, data, steps);
  begin_at_table(attempts, faults, health, data, steps);
  begin_health_again(healthy, attempts, data, steps);

  HypothesisFits out;
  out.degrees = data.degrees;
  out.visible = visible_of(faults, screened);
  out.healthy_square = std::move(health.square);
  out.work = health.work;
  for (const Screened& s : screened) out.work.add(s.work);
  out.fits.push_back(std::move(health.fit));
  for (Attempt& a : attempts) {
    out.work.add(a.work);
    out.fits.push_back(std::move(a.fit));
  }
  if (settings.pairs) fit_pairs(faults, data, out);
  return out;
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
