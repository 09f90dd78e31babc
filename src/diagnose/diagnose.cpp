#include "diagnose/diagnose.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "base/require_setting.h"
#include "base/stages.h"
#include "diagnose/constants.h"
#include "diagnose/flow_into_chambers.h"
#include "diagnose/gross.h"
#include "diagnose/hypotheses.h"
#include "diagnose/judgeable.h"
#include "diagnose/motion.h"
#include "diagnose/moved.h"
#include "diagnose/onset.h"
#include "diagnose/reading.h"
#include "diagnose/records.h"
#include "diagnose/visible.h"
#include "diagnose/whitening.h"
#include "diagnose/worth_fitting.h"
#include "evidence/conditions.h"
#include "evidence/constants.h"
#include "evidence/probabilities.h"
#include "faults/fault.h"
#include "faults/registry.h"
#include "fit/candidate_of.h"
#include "fit/chart.h"
#include "fit/error_model.h"
#include "fit/fast_log.h"
#include "fit/fit_work.h"
#include "fit/free_values.h"
#include "fit/log_data.h"
#include "fit/tuned_state.h"
#include "parameters/list.h"
#include "servodx/actions.h"
#include "servodx/data_sheet.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/operating_point.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "servodx/tune.h"
#include "signals/rig_content.h"
#include "signals/usual_step.h"
#include "simulate/scenario.h"
#include "tune/tune.h"

namespace servodx {
namespace {

namespace k = diagnose_constants;
using evidence_constants::effect_error;

ErrorModel required_error_model(const Table& tuned) {
  ErrorModel error = error_model_of(tuned);
  if (error.channels.empty())
    throw InputError({.file = tuned.path}, "the table does not say how wrong its model is",
                     "make it with 'servodx tune'; the file then carries lines '#% ...' ahead of its header");
  return error;
}

HypothesisSettings settings_of(const Table& tuned, const RigFile& rig, const DiagnoseOptions& options) {
  HypothesisSettings settings;
  for (const Fault* fault : fault_list())
    if (fault->counted_in) settings.times_drawing[fault] = times_drawing(*fault->counted_in, tuned, rig);
  settings.null_limit = rig.null_limit;
  settings.threads = options.threads;
  settings.stop = options.watch.stop;
  if (options.search == FaultSearch::genetic) settings.genetic = {options.population, options.seed};
  return settings;
}

// The seed is of the genetic search alone, which the attempts' stages do not name.
Stages stages_of(const std::vector<Log>& logs, const Table& tuned, const RigFile& rig, const DiagnoseOptions& options) {
  if (!options.watch.checkpoint) return {};
  std::vector<std::string> content;
  for (const Log& log : logs) content.push_back(content_hash(log));
  const bool genetic = options.search == FaultSearch::genetic;
  return {options.watch,
          "assess",
          content,
          content_hash(tuned),
          content_bytes(rig),
          options.search,
          genetic ? options.seed : 0};
}

// Logs of one valve in one state, made ready.
struct Ready {
  std::vector<LogData> data;
  std::vector<LogData> recorded;  // the same sample by sample, where a fast log is fitted at points; else empty
  const LogData& every_sample(std::size_t log) const { return recorded[log].path.empty() ? data[log] : recorded[log]; }
  std::vector<const LogData*> pointers() const {
    std::vector<const LogData*> out;
    for (const LogData& d : data) out.push_back(&d);
    return out;
  }
};

// A change in mid-log has its parts fitted alone: about a third as much work again.
HypothesisFits fit_whole(const Ready& ready, const ParameterVector& base, const ErrorModel& error,
                         HypothesisSettings settings, const DiagnoseOptions& options) {
  const bool one = ready.data.size() == 1;
  const double first_part = one && onset_possible(ready.data.front()) ? 0.75 : 1.0;
  if (options.watch.progress)
    settings.progress = [&](double part, long simulations) {
      options.watch.tell("diagnose", first_part * part, simulations);
    };
  return fit_hypotheses(ready.pointers(), base, error, settings);
}

// Of several logs a channel's squares are pooled.
std::vector<ChannelResult> channels_of(const std::vector<Log>& logs, const Ready& ready, const HypothesisFit& healthy) {
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

double scale_of(const HypothesisFits& fits) {
  return misfit_scale(fits.fits.front().misfit, fits.fits[best_fit(fits)].misfit, fits.degrees, effect_error);
}

double worst_channel(const HypothesisFit& f) {
  return f.channel_adequacy.empty() ? k::failed_adequacy
                                    : *std::max_element(f.channel_adequacy.begin(), f.channel_adequacy.end());
}

std::vector<PairResult> pairs_of(const HypothesisFits& fits) {
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

std::vector<HypothesisResult> results_of(const HypothesisFits& fits, const ParameterVector& base, const Table& tuned) {
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

// As gains of hypotheses are: beside what the model errs by.
std::vector<VisibleFault> visible_of(const HypothesisFits& fits) {
  const double inflation = misfit_inflation(fits.fits[best_fit(fits)].misfit, fits.degrees);
  std::vector<VisibleFault> out = fits.visible;
  for (VisibleFault& side : out)
    for (SeverityGain& g : side.gains) g.gain /= inflation;
  return out;
}

// Of several logs each log's figures; the worst stands out among all.
void look_at_records(const std::vector<Log>& logs, const Ready& ready, const ParameterVector& base, const RigFile& rig,
                     int threads, Assessment& out) {
  out.current_recorded = true;
  for (std::size_t l = 0; l < logs.size(); ++l) {
    const LogData& data = ready.every_sample(l);
    for (RecordFigure& f : record_figures(logs[l], data, base)) out.figures.push_back(std::move(f));
    std::vector<BrokenSensor> broken = broken_sensors(data, reference_of(data, base, threads));
    if (names_exchanged_ports(broken))
      broken = beside_flow(std::move(broken), chambers_by_flow(logs[l], rig, 1 / usual_step(logs[l].time)));
    out.broken.insert(out.broken.end(), broken.begin(), broken.end());
    out.current_recorded = out.current_recorded && data.scenario.current_measured;
  }
}

Ready make_ready(const std::vector<Log>& logs, const Table& tuned, const RigFile& rig, const ErrorModel& error,
                 Assessment& out) {
  Ready ready;
  for (const Log& log : logs) {
    out.log += (out.log.empty() ? "" : " + ") + log.path;
    out.sha256 += log.sha256, out.content += content_hash(log);
    out.logs.push_back(log.path);
    out.notes.insert(out.notes.end(), log.notes.begin(), log.notes.end());
    const bool fast = is_fast(log);
    ready.recorded.push_back(fast ? prepare(log, rig, recorder_of(tuned)) : LogData{});
    ready.data.push_back(fast ? at_points(ready.recorded.back()) : prepare(log, rig, recorder_of(tuned)));
    for (const Note& note : ready.data.back().notes)
      if (note.kind == Note::Kind::resampled) out.notes.push_back(note);
    leave_out_unknown_channels(ready.recorded.back(), error);
    for (Note& note : leave_out_unknown_channels(ready.data.back(), error)) out.notes.push_back(std::move(note));
    require_channels(ready.data.back());
  }
  out.test = conditions_of(logs.front());
  out.point = operating_point_of(logs.front());
  out.sheet = sheet_point(rig);
  return ready;
}

// What hypotheses that speak of all of a log leave of what moves in it. Gives the run of health there.
Trajectory leave_motion(const LogData& log, const std::vector<const HypothesisPrediction*>& by,
                        const ParameterVector& base, int threads, std::vector<HypothesisResult>& results) {
  std::vector<const ParameterVector*> candidates = {&base};
  for (const HypothesisPrediction* e : by) candidates.push_back(&e->candidate);
  std::vector<Trajectory> runs = references_of(log, candidates, threads);
  for (std::size_t i = 0; i < by.size(); ++i) {
    const double left = mean_left(motion_left(log, runs.front(), runs[i + 1]), 0);
    for (HypothesisResult& h : results)
      if (h.fault == by[i]->fault) h.motion_left = left;
  }
  return std::move(runs.front());
}

// What each hypothesis leaves of what moves, in the part of the log that it speaks of. A fault that steps in is
// simulated from there on, as it was fitted: from the beginning it would drive the piston to where the log's never was.
void look_at_motion(const LogData& data, const ParameterVector& base, int threads, Assessment& out) {
  std::vector<const HypothesisPrediction*> whole, since;
  for (const HypothesisPrediction& e : out.explanations) (e.from > 0 ? since : whole).push_back(&e);
  const Trajectory healthy = leave_motion(data, whole, base, threads, out.hypotheses);
  if (!since.empty())
    leave_motion(slice(data, since.front()->from, data.scenario.time.size()), since, base, threads, out.hypotheses);
  std::vector<MotionLeft> left = motion_left(data, healthy, healthy);
  std::erase_if(left, [&](const MotionLeft& m) {
    return std::any_of(out.broken.begin(), out.broken.end(), [&](const auto& b) { return b.signal == m.signal; });
  });
  out.others_left = mean_left(left, 0);
}

const HypothesisResult& best_of(const Assessment& a) {
  return *std::min_element(a.hypotheses.begin(), a.hypotheses.end(),
                           [](const auto& x, const auto& y) { return x.misfit < y.misfit; });
}
// Of the motion, by the hypothesis that fits best.
double left_by_best(const Assessment& a) { return best_of(a).motion_left; }

Unjudgeable unjudgeable_of(const Ready& ready, const ParameterVector& base, const OperatingPoint& point) {
  if (const Unjudgeable why = unjudgeable(point); why != Unjudgeable::no) return why;
  for (std::size_t l = 0; l < ready.data.size(); ++l)
    if (const Unjudgeable why = unjudgeable(ready.every_sample(l), base); why != Unjudgeable::no) return why;
  return Unjudgeable::no;
}

// Where little of the motion is left as it was read, that is the model's own error too, and the motion alone tells no
// reading from a fault: a slow log at twice its time moves nearly as it did. A reading then has to make a healthy log
// of it: health, fitted, is by far less wrong than the best hypothesis is of the log as it was read.
bool makes_a_healthy_log(const Reading& reading, const Log& log, const ParameterVector& base, const ReadingTrial& trial,
                         const HypothesisSettings& settings, const Assessment& as_read, FitWork& work) {
  if (!(reading.left < k::misread_beside * left_by_best(as_read))) return false;
  LogData data = prepare_at_points(read_as(log, reading), trial.rig, recorder_of(trial.tuned));
  leave_out_unknown_channels(data, trial.error);
  const auto adequacy = healthy_adequacy(data, "read otherwise", base, trial.error, settings, work);
  return adequacy && *adequacy < k::misread_beside * best_of(as_read).adequacy;
}

// Where the best fit leaves much of the motion, or health fits worse than a fault may: was the log read wrongly? A log
// that its best fit leaves as tuning logs are left asks for no other reading.
void look_at_readings(const Log& log, const ParameterVector& base, const ReadingTrial& trial,
                      const HypothesisSettings& settings, Assessment& out, FitWork& work) {
  const bool much = left_by_best(out) > k::worth_reading;
  const bool told = best_of(out).adequacy <= k::told_as_it_is || out.hypotheses.front().adequacy <= k::fault_allowance;
  if (!much && told) return;
  out.reading = best_reading(log, Unjudgeable::no, trial);
  if (!much && out.reading && !makes_a_healthy_log(*out.reading, log, base, trial, settings, out, work))
    out.reading.reset();
}

// Health alone, and nothing known of it: where there is nothing to judge there is nothing to fit.
HypothesisResult not_fitted() {
  HypothesisResult health;
  health.adequacy = k::failed_adequacy;
  return health;
}

}  // namespace

void DiagnoseOptions::validate() const {
  require_threads(threads, "DiagnoseOptions.threads");
  for (const auto& [label, action] : default_actions())
    require_setting(actions.contains(label), "DiagnoseOptions.actions", "there is none for '" + label + "'",
                    "begin with default_actions(), and change what is another");
  require_setting(population >= k::least_population && population <= k::most_population, "DiagnoseOptions.population",
                  fmt::format("a sub-group of {}", population),
                  fmt::format("give {} to {}", k::least_population, k::most_population));
}

Assessment assess_pool(const std::vector<Log>& logs, const Table& tuned, const RigFile& rig,
                       const DiagnoseOptions& options) {
  options.validate();
  Assessment out;
  const ErrorModel error = required_error_model(tuned);
  const Ready ready = make_ready(logs, tuned, rig, error, out);
  const ParameterVector base = candidate_of(tuned);
  HypothesisSettings settings = settings_of(tuned, rig, options);
  settings.stages = stages_of(logs, tuned, rig, options);
  const ReadingTrial trial{tuned, rig, error, options.threads};
  out.unjudgeable = unjudgeable_of(ready, base, out.point);
  if (out.unjudgeable != Unjudgeable::no) {
    out.hypotheses.push_back(not_fitted());
    for (std::size_t l = 0; l < logs.size() && out.unjudgeable == Unjudgeable::nothing_asked; ++l)
      for (RecordFigure& f : driver_figures(logs[l], ready.every_sample(l))) out.figures.push_back(std::move(f));
    if (logs.size() == 1) out.reading = best_reading(logs.front(), out.unjudgeable, trial);
    return out;
  }

  HypothesisFits fits = fit_whole(ready, base, error, settings, options);
  FitWork work = fits.work;
  const bool stopped = options.watch.stopped();
  if (!stopped) {
    const LogData& first = ready.data.front();
    out.gross = gross_finding(ready.every_sample(0), base);
    look_at_records(logs, ready, base, rig, options.threads, out);
    out.channels = channels_of(logs, ready, fits.fits.front());
    out.visible = visible_of(fits);
    std::optional<Onset> onset;
    if (logs.size() == 1) onset = find_onset(first, base, error, settings, fits, work);
    if (onset) {
      out.onset = first.scenario.time[onset->at];
      fits = std::move(onset->after);
    }
    out.explanations = explanations_of(base, fits, onset);
    out.hypotheses = results_of(fits, base, tuned);
    out.misfit_scale = scale_of(fits);
    out.pairs = pairs_of(fits);
    look_at_motion(first, base, options.threads, out);
    if (logs.size() == 1) look_at_readings(logs.front(), base, trial, settings, out, work);
  }
  out.simulations = work.simulations, out.failed_simulations = work.failed;
  return out;
}

Assessment assess(const Log& log, const Table& tuned, const RigFile& rig, const DiagnoseOptions& options) {
  return assess_pool({log}, tuned, rig, options);
}

Diagnosis diagnose(const Log& log, const Table& tuned, const RigFile& rig, const DetectionBaseline& baseline,
                   const DiagnoseOptions& options) {
  return judge(assess(log, tuned, rig, options), baseline);
}

}  // namespace servodx
