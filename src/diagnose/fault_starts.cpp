#include "diagnose/fault_starts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/stages.h"
#include "diagnose/constants.h"
#include "diagnose/kept.h"
#include "diagnose/severity.h"
#include "evidence/probabilities.h"

namespace servodx {

namespace {

namespace k = diagnose_constants;

}  // namespace

std::vector<Screened> screen_starts(const std::vector<const Fault*>& faults, const HypothesisData& data,
                                    const Origin& origin, FitSteps& steps) {
  std::vector<Screened> screened;
  for (const Fault* fault : faults)
    for (double severity :
         starting_severities(*fault, data.base, data.settings.null_limit, data.settings.times_drawing))
      screened.push_back({fault, severity});
  const auto run_all = [&] {
    each_fit(screened.size(), data, [&](std::size_t i) {
      screen(screened[i], data, origin.fit, origin.end ? &*origin.end : nullptr);
      steps.done(FitSteps::screening * static_cast<double>(faults.size()) / static_cast<double>(screened.size()),
                 screened[i].work.simulations);
    });
    return screened;
  };
  screened = data.settings.stages.made("screen", run_all, screened, origin.fit, origin.end.has_value());
  std::stable_sort(screened.begin(), screened.end(),
                   [](const Screened& a, const Screened& b) { return a.left < b.left; });
  return screened;
}

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

std::vector<Attempt> starts_of_sides(const std::vector<const Fault*>& faults, const std::vector<Screened>& screened) {
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

std::vector<VisibleFault> screened_gains(const std::vector<const Fault*>& faults,
                                         const std::vector<Screened>& screened) {
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

}  // namespace servodx
