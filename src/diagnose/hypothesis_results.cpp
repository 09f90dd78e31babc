#include "diagnose/hypothesis_results.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "diagnose/constants.h"
#include "diagnose/moved.h"
#include "diagnose/worth_fitting.h"
#include "evidence/constants.h"
#include "evidence/probabilities.h"
#include "faults/fault.h"
#include "fit/chart.h"
#include "fit/log_data.h"
#include "parameters/list.h"

namespace servodx {
namespace {

namespace k = diagnose_constants;
using evidence_constants::effect_error;

ParameterVector candidate_at(const ParameterVector& base, const HypothesisFit& f) {
  return Chart(base, f.free).candidate(f.point, 0);
}

double worst_channel(const HypothesisFit& f) {
  return f.channel_adequacy.empty() ? k::failed_adequacy
                                    : *std::max_element(f.channel_adequacy.begin(), f.channel_adequacy.end());
}

}  // namespace

std::vector<HypothesisResult> hypothesis_results(const HypothesisFits& fits, const ParameterVector& base,
                                                 const Table& tuned) {
  const double inflation = misfit_inflation(fits.fits[best_fit(fits)].misfit, fits.degrees);
  std::vector<HypothesisResult> out;
  for (std::size_t i = 0; i < fits.fits.size(); ++i) {
    const HypothesisFit& f = fits.fits[i];
    HypothesisResult r;
    r.fault = f.fault;
    r.misfit = f.misfit;
    r.gain = f.ok ? (fits.fits.front().misfit - f.misfit) / inflation : 0.0;
    r.severity = f.severity;
    r.severity_lower = std::min(f.severity_lower, f.severity_upper);
    r.severity_upper = std::max(f.severity_lower, f.severity_upper);
    r.at_least = f.at_least, r.at_worst = f.at_worst, r.shapes = f.shapes;
    r.adequacy = worst_channel(f);
    if (f.ok) r.null = candidate_at(base, f)[row::servovalve_null];
    r.moved = moved_rows(f, base, tuned);
    r.stops = f.stops;
    out.push_back(std::move(r));
  }
  return out;
}

std::vector<PairResult> pair_results(const HypothesisFits& fits) {
  const auto alone = [&](const Fault* fault) {
    const auto it = std::find_if(fits.fits.begin(), fits.fits.end(), [&](const auto& f) { return f.fault == fault; });
    return it == fits.fits.end() ? fits.fits.front().misfit : it->misfit;
  };
  const double healthy = fits.fits.front().misfit, best = fits.fits[best_fit(fits)].misfit;
  std::vector<PairResult> out;
  for (const HypothesisFit& f : fits.pairs) {
    PairResult p{f, *f.beside};
    if (alone(p.second.fault) < alone(p.first.fault)) std::swap(p.first, p.second);
    p.misfit = f.misfit;
    p.gain = pair_gain(f.misfit, best, healthy) / misfit_scale(healthy, f.misfit, fits.degrees, effect_error);
    p.of_effect = (best - f.misfit) / std::max(1e-9, healthy - f.misfit);
    p.adequacy = worst_channel(f);
    out.push_back(p);
  }
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.misfit < b.misfit; });
  return out;
}

std::vector<VisibleFault> visible_beside_error(const HypothesisFits& fits) {
  const double inflation = misfit_inflation(fits.fits[best_fit(fits)].misfit, fits.degrees);
  std::vector<VisibleFault> out = fits.visible;
  for (VisibleFault& side : out)
    for (SeverityGain& g : side.gains) g.gain /= inflation;
  return out;
}

double scale_of_misfits(const HypothesisFits& fits) {
  return misfit_scale(fits.fits.front().misfit, fits.fits[best_fit(fits)].misfit, fits.degrees, effect_error);
}

std::vector<HypothesisPrediction> predictions_of(const ParameterVector& base, const HypothesisFits& fits,
                                                 const std::optional<Onset>& onset) {
  std::vector<HypothesisPrediction> out;
  const auto add = [&](const HypothesisFit& f, std::size_t from) {
    if (f.ok) out.push_back({f.fault, candidate_at(base, f), from});
  };
  if (onset) add(onset->healthy_before, 0);
  for (const HypothesisFit& f : fits.fits)
    if (f.fault || !onset) add(f, onset ? onset->at : 0);
  return out;
}

std::vector<ChannelResult> channels_under(const HypothesisFit& healthy, const std::vector<Log>& logs,
                                          const ReadyLogs& ready) {
  struct Sum {
    double square = 0, noise = 0, logs = 0;
    std::string unit;
  };
  std::map<Signal, Sum> sums;
  std::size_t at = 0;
  for (std::size_t l = 0; l < logs.size(); ++l)
    for (const FitChannel& c : ready.data[l].channels) {
      if (at >= healthy.channel_rms.size()) break;
      Sum& s = sums[c.signal];
      const double rms = healthy.channel_rms[at++];
      s.square += rms * rms, s.noise += c.noise * c.noise, ++s.logs;
      if (s.unit.empty()) s.unit = logs[l].channels[index(c.signal)].unit;
    }
  std::vector<ChannelResult> out;
  for (const FitChannel& c : ready.data.front().channels)
    if (const auto it = sums.find(c.signal); it != sums.end()) {
      const Sum& s = it->second;
      const double rms = std::sqrt(s.square / s.logs);
      out.push_back({c.signal, s.unit, rms, std::sqrt(s.noise / s.logs), rms});
    }
  return out;
}

}  // namespace servodx
