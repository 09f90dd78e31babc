#include "diagnose/onset.h"

#include <algorithm>
#include <cmath>

#include "diagnose/constants.h"
#include "diagnose/health_fit.h"
#include "evidence/probabilities.h"
#include "fit/error_model.h"
#include "fit/log_data.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

namespace k = diagnose_constants;

// Where to cut: a change of the whole log's healthy residual, and one of the residual beyond a healthy beginning.
std::vector<std::size_t> likely_changes(const LogData& log, const ParameterVector& base, const ErrorModel& error,
                                        const HypothesisSettings& settings, const HypothesisFits& whole,
                                        FitWork& work) {
  std::vector<std::size_t> changes;
  if (const auto at = variance_step_up(whole.healthy_square, whole.degrees)) changes.push_back(*at);
  if (!onset_possible(log)) return changes;
  // A large fault drags the nuisances of the whole log along, and nothing is quiet: health is asked of the beginning.
  const std::size_t beginning = std::max(k::shortest_part, log.scenario.time.size() / k::beginning_one_in);
  const std::vector<double> square = square_beyond_beginning(log, beginning, base, error, settings, work);
  const auto at = square.empty() ? std::nullopt : variance_step_up(square, whole.degrees);
  if (at && (changes.empty() || changes.front() != *at)) changes.push_back(*at);
  return changes;
}

}  // namespace

std::optional<std::size_t> variance_step_up(const std::vector<double>& square, double independent) {
  const std::size_t n = square.size();
  std::vector<double> sum(n + 1, 0.0);
  for (std::size_t i = 0; i < n; ++i) sum[i + 1] = sum[i] + square[i];
  const auto margin = std::max(k::shortest_part, n / k::shortest_one_in);  // each part must speak for itself
  if (n < k::fewest_parts * margin || sum[n] <= 0) return {};
  std::optional<std::size_t> best;
  const double whole = static_cast<double>(n) * std::log(sum[n] / static_cast<double>(n));
  double best_cost = whole;
  for (std::size_t i = margin; i + margin <= n; ++i) {
    const double before = sum[i] / static_cast<double>(i), after = (sum[n] - sum[i]) / static_cast<double>(n - i);
    if (after < k::variance_step * before || before <= 0) continue;
    const double cost = static_cast<double>(i) * std::log(before) + static_cast<double>(n - i) * std::log(after);
    if (cost < best_cost) best_cost = cost, best = i;
  }
  // Scaled to independent samples.
  if ((whole - best_cost) * independent / static_cast<double>(n) / k::fall_to_gain > k::change_gain) return best;
  return {};
}

bool is_onset(const SplitGains& g, double independent) {
  const double inflation = misfit_inflation(g.split, independent);
  return g.after / inflation > k::onset_gain && g.before < k::gain_before_part * g.after &&
         (g.whole - g.split) / inflation > k::onset_gain;
}

bool onset_possible(const LogData& log) { return log.scenario.time.size() >= k::fewest_parts * k::shortest_part; }

std::optional<Onset> find_onset(const LogData& log, const ParameterVector& base, const ErrorModel& error,
                                const HypothesisSettings& settings, const HypothesisFits& whole, FitWork& work) {
  std::optional<Onset> onset;  // of the changes the one that leaves least
  double least = 0;
  for (const std::size_t at : likely_changes(log, base, error, settings, whole, work)) {
    const LogData first = slice(log, 0, at), rest = slice(log, at, log.scenario.time.size());
    HypothesisSettings single = settings;
    single.pairs = false;
    single.stages = settings.stages.part("before", at);
    const HypothesisFits before = fit_hypotheses({&first}, base, error, single);
    single.stages = settings.stages.part("after", at);
    HypothesisFits after = fit_hypotheses({&rest}, base, error, single);
    work.add(before.work), work.add(after.work);
    // What was gone before cannot be the fault that is there after: that fault gains next to nothing before.
    const std::size_t fault = best_fit(after);
    SplitGains gains;
    gains.whole = whole.fits[best_fit(whole)].misfit;
    gains.split = before.fits.front().misfit + after.fits[fault].misfit;
    gains.before = before.fits.front().misfit - before.fits[fault].misfit;
    gains.after = after.fits.front().misfit - after.fits[fault].misfit;
    if (!is_onset(gains, whole.degrees) || (onset && gains.split >= least)) continue;
    least = gains.split;
    onset = Onset{at, before.fits.front(), std::move(after)};
  }
  return onset;
}

}  // namespace servodx
