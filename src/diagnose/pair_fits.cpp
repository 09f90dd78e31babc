#include "diagnose/pair_fits.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "base/stages.h"
#include "diagnose/constants.h"
#include "diagnose/fit_steps.h"
#include "diagnose/kept.h"
#include "diagnose/severity.h"
#include "diagnose/worth_fitting.h"
#include "evidence/probabilities.h"
#include "faults/registry.h"

namespace servodx {
namespace {

namespace k = diagnose_constants;

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
    each_fit(screened.size(), data,
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

}  // namespace

std::vector<HypothesisFit> fit_pairs(const std::vector<const Fault*>& faults, const HypothesisData& data,
                                     const HypothesisFits& singles, FitWork& work) {
  std::vector<HypothesisFit> out;
  if (!pair_could_gain(singles.fits[best_fit(singles)].misfit, singles.fits.front().misfit)) return out;
  std::vector<Leader> leaders;
  for (const HypothesisFit* fit : leading(singles)) leaders.push_back({fit, end_of(*fit, data, work)});
  std::vector<PairStart> pairs = pair_starts(faults, leaders, data, work);
  each_fit(pairs.size(), data, [&](std::size_t i) {
    const Leader& leader = *pairs[i].leader;
    if (leader.end) approach(pairs[i].attempt, data, leader.fit, *leader.end, k::approach_iterations);
  });
  const auto nearer = [](auto& a, auto& b) { return a.attempt.fit.misfit < b.attempt.fit.misfit; };
  std::stable_sort(pairs.begin(), pairs.end(), nearer);
  each_fit(std::min(k::pair_finalists, pairs.size()), data,
           [&](std::size_t i) { run(pairs[i].attempt, data, nullptr, data.settings.iterations); });
  for (PairStart& pair : pairs) {
    work.add(pair.attempt.work);
    if (pair.attempt.fit.ok) out.push_back(std::move(pair.attempt.fit));
  }
  return out;
}

}  // namespace servodx
