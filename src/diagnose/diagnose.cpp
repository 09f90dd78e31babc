#include "diagnose/diagnose.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "diagnose/conditions.h"
#include "diagnose/constants.h"
#include "diagnose/gross.h"
#include "diagnose/hypotheses.h"
#include "diagnose/moved.h"
#include "diagnose/onset.h"
#include "evidence/probabilities.h"
#include "fit/chart.h"
#include "fit/error_model.h"
#include "fit/log_data.h"
#include "fit/nominal.h"
#include "fit/tuned_state.h"
#include "parameters/list.h"
#include "servodx/rig.h"
#include "simulate/scenario.h"
#include "tune/tune.h"

namespace servodx {
namespace {

namespace k = diagnose_constants;

constexpr double failed_adequacy = 1e3;  // of a hypothesis whose fit failed

ErrorModel required_error_model(const Table& tuned) {
  ErrorModel error = error_model_of(tuned);
  if (error.channels.empty())
    throw InputError({.file = tuned.path}, "the table does not say how wrong its model is",
                     "make it with 'servodx tune'; the file then carries lines '#% ...' ahead of its header");
  return error;
}

HypothesisSettings settings_of(const RigFile& rig, const DiagnoseOptions& options) {
  HypothesisSettings settings;
  settings.null_limit = rig.null_limit;
  settings.threads = options.threads;
  settings.stop = options.watch.stop;
  return settings;
}

// A change in mid-log has its parts fitted alone: about a third as much work again.
HypothesisFits fit_whole(const LogData& data, const ParameterVector& base, const ErrorModel& error,
                         HypothesisSettings settings, const DiagnoseOptions& options) {
  const double first_part = onset_possible(data) ? 0.75 : 1.0;
  if (options.watch.progress)
    settings.progress = [&](double part, long simulations) {
      options.watch.tell("diagnose", first_part * part, simulations);
    };
  return fit_hypotheses(data, base, error, settings);
}

std::vector<ChannelResult> channels_of(const Log& log, const LogData& data, const HypothesisFit& healthy) {
  std::vector<ChannelResult> out;
  for (std::size_t c = 0; c < data.channels.size() && c < healthy.channel_rms.size(); ++c)
    out.push_back({data.channels[c].signal, log.channels[index(data.channels[c].signal)].unit, healthy.channel_rms[c],
                   data.channels[c].noise, healthy.channel_rms[c]});
  return out;
}

ParameterVector candidate_at(const ParameterVector& base, const HypothesisFit& f) {
  return Chart(base, f.free).candidate(f.point, 0);
}

// Of a log with an onset, health speaks of the part before and the faults of the part after.
std::vector<HypothesisPrediction> explanations_of(const ParameterVector& base, const HypothesisFits& fits,
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

std::vector<double> weigh(const HypothesisFits& fits) {
  std::vector<WeighedHypothesis> weighed;
  for (const HypothesisFit& f : fits.fits) weighed.push_back({f.fault ? f.fault->prior : 1.0, f.misfit});
  return probabilities_of(
      weighed, misfit_scale(fits.fits.front().misfit, fits.fits[best_fit(fits)].misfit, fits.degrees, k::effect_error));
}

std::vector<HypothesisResult> results_of(const HypothesisFits& fits, const LogData& data, const ParameterVector& base,
                                         const Table& tuned) {
  const double inflation = misfit_inflation(fits.fits[best_fit(fits)].misfit, fits.degrees);
  const std::vector<double> probability = weigh(fits);
  std::vector<HypothesisResult> out;
  for (std::size_t i = 0; i < fits.fits.size(); ++i) {
    const HypothesisFit& f = fits.fits[i];
    HypothesisResult r;
    r.fault = f.fault;
    r.misfit = f.misfit;
    r.gain = f.ok ? (fits.fits.front().misfit - f.misfit) / inflation : 0.0;
    r.probability = probability[i];
    r.severity = f.severity;
    r.severity_lower = std::min(f.severity_lower, f.severity_upper);
    r.severity_upper = std::max(f.severity_lower, f.severity_upper);
    r.at_least = f.at_least, r.at_worst = f.at_worst;
    r.adequacy = f.channel_adequacy.empty() ? failed_adequacy
                                            : *std::max_element(f.channel_adequacy.begin(), f.channel_adequacy.end());
    if (f.ok) r.null = candidate_at(base, f)[row::servovalve_null];
    r.moved = moved_rows(f, data, base, tuned);
    r.stops = f.stops;
    out.push_back(std::move(r));
  }
  std::stable_sort(out.begin() + 1, out.end(),
                   [](const auto& a, const auto& b) { return a.probability > b.probability; });
  return out;
}

}  // namespace

void DiagnoseOptions::validate() const {
  if (threads < 0)
    throw InputError({.file = "DiagnoseOptions.threads"}, fmt::format("{} threads cannot run", threads),
                     "give 0 for all cores, or how many");
}

Assessment assess(const Log& log, const Table& tuned, const RigFile& rig, const DiagnoseOptions& options) {
  options.validate();
  Assessment out;
  out.log = log.path, out.sha256 = log.sha256, out.notes = log.notes;
  LogData data = prepare(log, rig, moving_average_of(tuned));
  const ErrorModel error = required_error_model(tuned);
  for (std::string& note : leave_out_unknown_channels(data, error)) out.notes.push_back(std::move(note));
  require_channels(data);
  const ParameterVector base = candidate_of(tuned);
  const HypothesisSettings settings = settings_of(rig, options);
  out.test = conditions_of(log);

  HypothesisFits fits = fit_whole(data, base, error, settings, options);
  FitWork work = fits.work;
  const bool stopped = options.watch.stopped();
  if (!stopped) {
    out.gross = gross_finding(data, base);
    out.channels = channels_of(log, data, fits.fits.front());
    std::optional<Onset> onset = find_onset(data, base, error, settings, fits, work);
    if (onset) {
      out.onset = data.scenario.time[onset->at];
      fits = std::move(onset->after);
    }
    out.explanations = explanations_of(base, fits, onset);
    out.hypotheses = results_of(fits, data, base, tuned);
  }
  out.simulations = work.simulations, out.failed_simulations = work.failed;
  return out;
}

Diagnosis diagnose(const Log& log, const Table& tuned, const RigFile& rig, const DetectionBaseline& baseline,
                   const DiagnoseOptions& options) {
  return judge(assess(log, tuned, rig, options), baseline);
}

}  // namespace servodx
