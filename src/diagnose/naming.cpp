#include "diagnose/naming.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "diagnose/assessment.h"
#include "diagnose/constants.h"
#include "diagnose/decide.h"
#include "diagnose/hypotheses.h"
#include "diagnose/record_law.h"
#include "evidence/posterior.h"

namespace servodx {
namespace {

// Probability of nothing, by the chance that health shows as much: even where the verdict turns, so that no probability
// contradicts it.
double nothing_by(double chance, double rate) {
  const double odds = factor_for_nothing(chance) / factor_for_nothing(rate);
  return odds / (1 + odds);
}
double sure_of(double chance, double rate) { return 1 - nothing_by(chance, rate); }

NamedFault named_outright(const HypothesisResult& h) {  // the worst, up to the mildest that the finding leaves open
  const double worst = h.fault->worst, mildest = h.fault->seen_outright->mildest;
  return {h.fault,
          1.0,
          worst,
          worst < mildest ? worst : std::min(mildest, h.severity_lower),
          worst < mildest ? std::max(mildest, h.severity_upper) : worst,
          {}};
}

NamedFault sized(const FaultSize& size, double probability) {
  return {size.fault, probability, size.severity, size.severity_lower, size.severity_upper, {}};
}

// The faults share what health leaves as their fits do.
std::vector<double> beside_health(const Named& of) {
  std::vector<double> p = of.decision.probabilities;
  const double faults = std::accumulate(p.begin() + 1, p.end(), 0.0);
  const bool settled = of.decision.severity == SeveritySource::seen_outright;
  if (settled || !(faults > 0)) return p;
  p.front() = nothing_by(of.law.chance_of_gain(of.gain), of.law.rate());
  for (std::size_t i = 1; i < p.size(); ++i) p[i] *= (1 - p.front()) / faults;
  return p;
}

void name_valve(const Named& of, std::vector<NamedFault>& out) {
  const HypothesisResult& told = of.assessment.hypotheses[of.decision.hypothesis];
  if (of.decision.severity == SeveritySource::seen_outright) return out.push_back(named_outright(told));
  if (!of.decision.beside)
    return out.push_back({told.fault,
                          beside_health(of)[of.decision.hypothesis],
                          told.severity,
                          told.severity_lower,
                          told.severity_upper,
                          {}});
  const PairResult& pair = of.assessment.pairs.front();
  out.push_back(sized(pair.first, sure_of(of.law.chance_of_gain(of.gain), of.law.rate())));
  out.push_back(sized(pair.second, sure_of(of.law.chance_of_gain(of.gain_of_second), of.law.rate())));
}

}  // namespace

std::vector<NamedFault> name_faults(const Named& of) {
  std::vector<NamedFault> out;
  if (of.decision.verdict != VerdictKind::fault) return out;
  if (of.decision.record) {
    const RecordFinding& f = of.records[*of.decision.record];
    out.push_back({f.fault, sure_of(f.chance, of.rate_of_records), f.severity, f.lower, f.upper, f});
  }
  if (!of.decision.record || of.decision.valve_too) name_valve(of, out);
  return out;
}

std::vector<FaultProbability> probabilities_of(const Named& of, const std::vector<NamedFault>& faults) {
  const bool unknown = of.decision.verdict == VerdictKind::unknown;
  const std::vector<double> weighed = unknown ? of.decision.probabilities : beside_health(of);
  std::vector<FaultProbability> out;
  for (std::size_t i = 0; i < weighed.size(); ++i) out.push_back({of.assessment.hypotheses[i].fault, weighed[i]});
  if (faults.empty()) return out;
  if (faults.front().record)  // what the fits say shares what the record leaves
    for (FaultProbability& p : out) p.value *= 1 - faults.front().probability;
  for (const NamedFault& f : faults) {
    const auto same = std::find_if(out.begin(), out.end(), [&](const auto& p) { return p.of == f.fault; });
    if (same == out.end())
      out.push_back({f.fault, f.probability});
    else
      same->value = f.probability;
  }
  return out;
}

}  // namespace servodx
