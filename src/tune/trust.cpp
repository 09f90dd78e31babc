#include "tune/trust.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "servodx/tune.h"
#include "tune/constants.h"

namespace servodx {
namespace {

bool has_arrived(const TrustEvidence& e) {
  switch (e.stop) {
    case StopReason::converged:
    case StopReason::goal:
      return true;
    case StopReason::stalled:
    case StopReason::iteration_limit:
    case StopReason::evaluation_limit:
      return e.still_promised <= tune_constants::worth_a_step + tune_constants::tells_valleys * e.cost;
    case StopReason::interrupted:
    case StopReason::start_failed:
      return false;
  }
  return false;
}

// Of the median log; 0 where nothing is held out.
double usual_of(const std::vector<TrustEvidence::Prediction>& logs) {
  if (logs.empty()) return 0;
  std::vector<double> ratios;
  for (const TrustEvidence::Prediction& p : logs) ratios.push_back(p.over_fitted);
  std::sort(ratios.begin(), ratios.end());
  return ratios[ratios.size() / 2];
}

void judge_channel(const TrustEvidence::Channel& c, TrustVerdict& v) {
  if (c.noise > 0 && c.error > tune_constants::another_sheet_over_noise * c.noise)
    v.beyond_noise.push_back({c.signal, c.error / c.noise});
  if (const double usual = usual_of(c.logs); usual > tune_constants::predicts_worse) {
    v.worse.push_back({c.signal, usual});
    return;
  }
  const auto worst = std::ranges::max_element(c.logs, {}, &TrustEvidence::Prediction::over_fitted);
  if (worst != c.logs.end() && worst->over_fitted > tune_constants::predicts_worse)
    v.exceptions.push_back({c.signal, worst->log, worst->over_fitted});
}

}  // namespace

TrustEvidence evidence_of(const TuneResult& result, std::vector<TrustEvidence::Fault> faults) {
  TrustEvidence e;
  e.interrupted = result.interrupted;
  e.unfollowed = !result.unfollowed.empty(), e.off_drawing = !result.off_drawing.empty();
  for (const ChannelResult& pooled : result.channels) {
    TrustEvidence::Channel& channel = e.channels.emplace_back();
    channel.signal = pooled.signal, channel.error = pooled.rms, channel.noise = pooled.noise_rms;
    for (std::size_t log = 0; log < result.logs.size(); ++log)
      for (const ChannelResult& c : result.logs[log].channels)
        if (c.signal == pooled.signal && c.rms > 0 && std::isfinite(c.heldout_rms))
          channel.logs.push_back({log, c.heldout_rms / c.rms});
  }
  e.stop = result.stop, e.cost = result.cost, e.still_promised = result.still_promised;
  e.starts = result.starts.size(), e.in_best_valley = result.reached_best();
  e.faults = std::move(faults);
  return e;
}

TrustVerdict trust_in(const TrustEvidence& e) {
  TrustVerdict v;
  for (const TrustEvidence::Channel& c : e.channels) judge_channel(c, v);
  for (std::size_t k = 0; k < e.faults.size(); ++k) {
    if (!(e.faults[k].at_typical >= tune_constants::seen))
      v.hidden.push_back(k);
    else if (!(e.faults[k].at_least >= tune_constants::seen))
      v.faint.push_back(k);
  }
  const std::pair<TrustDoubt, bool> doubts[] = {
      {TrustDoubt::interrupted, e.interrupted},
      {TrustDoubt::unfollowed, e.unfollowed},
      {TrustDoubt::another_sheet, !v.beyond_noise.empty()},
      {TrustDoubt::off_drawing, e.off_drawing},
      {TrustDoubt::predicts_worse, !v.worse.empty()},
      {TrustDoubt::not_arrived, !has_arrived(e) && !e.interrupted},
      {TrustDoubt::lone_valley, e.starts > 1 && e.in_best_valley < 2},
      {TrustDoubt::hidden_faults, !v.hidden.empty()},
  };
  for (const auto& [doubt, there] : doubts)
    if (there) v.doubts.push_back(doubt);
  v.trust = e.unfollowed ? Trust::no : v.doubts.empty() ? Trust::yes : Trust::with_care;
  return v;
}

}  // namespace servodx
