#include "diagnose/diagnose.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "diagnose/constants.h"
#include "diagnose/gross.h"
#include "diagnose/hypotheses.h"
#include "diagnose/hypothesis_results.h"
#include "diagnose/hypothesis_settings.h"
#include "diagnose/judgeable.h"
#include "diagnose/motion_by_hypothesis.h"
#include "diagnose/onset.h"
#include "diagnose/other_reading.h"
#include "diagnose/reading.h"
#include "diagnose/ready_logs.h"
#include "diagnose/records.h"
#include "evidence/conditions.h"
#include "fit/candidate_of.h"
#include "fit/error_model.h"
#include "fit/fit_work.h"
#include "fit/log_data.h"
#include "fit/tuned_state.h"
#include "servodx/data_sheet.h"
#include "servodx/log.h"
#include "servodx/operating_point.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

// One order whatever the logs were given in, so that nothing hangs on which came first.
std::vector<Log> in_order_of_content(const std::vector<Log>& logs) {
  std::vector<std::pair<std::string, const Log*>> by_content;
  for (const Log& log : logs) by_content.emplace_back(content_hash(log), &log);
  std::stable_sort(by_content.begin(), by_content.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Log> out;
  for (const auto& [content, log] : by_content) out.push_back(*log);
  return out;
}

// Which logs they are, and where they were recorded.
Assessment opened(const std::vector<Log>& given, const std::vector<Log>& logs, const ReadyLogs& ready,
                  const RigFile& rig) {
  Assessment out;
  for (const Log& log : given) {
    out.log += (out.log.empty() ? "" : " + ") + log.path;
    out.sha256 += log.sha256, out.content += content_hash(log);
    out.logs.push_back(log.path);
  }
  out.notes = ready.notes;
  for (const Log& log : logs) {
    out.tests.push_back(conditions_of(log));
    out.points.push_back(operating_point_of(log));
  }
  out.test = out.tests.front();
  out.sheet = sheet_point(rig);
  return out;
}

// Where there is nothing to judge there is nothing to fit: health alone, and nothing known of it.
Assessment without_fit(Assessment out, const std::vector<Log>& logs, const ReadyLogs& ready,
                       const ReadingTrial& trial) {
  out.hypotheses.emplace_back().adequacy = diagnose_constants::failed_adequacy;
  if (out.unjudgeable == Unjudgeable::nothing_asked) out.figures = driver_figures(logs, ready);
  if (logs.size() == 1) out.reading = best_reading(logs.front(), out.unjudgeable, trial);
  return out;
}

// A change in mid-log has its parts fitted alone: about a third as much work again.
HypothesisFits fit_whole(const ReadyLogs& ready, const ParameterVector& base, const ErrorModel& error,
                         HypothesisSettings settings, const DiagnoseOptions& options) {
  const bool one = ready.data.size() == 1;
  const double first_part = one && onset_possible(ready.data.front()) ? 0.75 : 1.0;
  if (options.watch.progress)
    settings.progress = [&](double part, long simulations) {
      options.watch.tell("diagnose", first_part * part, simulations);
    };
  return fit_hypotheses(ready.pointers(), base, error, settings);
}

void add_records(RecordsOfLogs records, Assessment& out) {
  out.figures = std::move(records.figures);
  out.broken = std::move(records.broken);
  out.current_recorded = records.current_recorded;
}

void add_results(const HypothesisFits& fits, const ParameterVector& base, const Table& tuned,
                 const std::optional<Onset>& onset, Assessment& out) {
  out.explanations = predictions_of(base, fits, onset);
  out.hypotheses = hypothesis_results(fits, base, tuned);
  out.misfit_scale = scale_of_misfits(fits);
  out.pairs = pair_results(fits);
}

void add_motion(const MotionByHypothesis& motion, Assessment& out) {
  for (const MotionByHypothesis::Left& left : motion.left)
    for (HypothesisResult& h : out.hypotheses)
      if (h.fault == left.by) h.motion_left = left.part;
  out.others_left = motion.others;
}

}  // namespace

Assessment assess_pool(const std::vector<Log>& given, const Table& tuned, const RigFile& rig,
                       const DiagnoseOptions& options) {
  options.validate();
  const std::vector<Log> ordered = given.size() > 1 ? in_order_of_content(given) : std::vector<Log>();
  const std::vector<Log>& logs = given.size() > 1 ? ordered : given;
  const ErrorModel error = required_error_model(tuned);
  const ReadyLogs ready = make_ready(logs, tuned, rig, error);
  const ParameterVector base = candidate_of(tuned);
  const HypothesisSettings settings = hypothesis_settings(logs, tuned, rig, options);
  const ReadingTrial trial{tuned, rig, error, options.threads};
  Assessment out = opened(given, logs, ready, rig);
  out.unjudgeable = unjudgeable(ready, base, out.points);
  if (out.unjudgeable != Unjudgeable::no) return without_fit(std::move(out), logs, ready, trial);

  const HypothesisFits whole = fit_whole(ready, base, error, settings, options);
  FitWork work = whole.work;
  if (!options.watch.stopped()) {
    const bool one = logs.size() == 1;
    const LogData& first = ready.data.front();
    out.gross = gross_finding(ready, base);
    add_records(look_at_records(logs, ready, base, rig, options.threads), out);
    out.channels = channels_under(whole.fits.front(), logs, ready);
    out.visible = visible_beside_error(whole);
    const std::optional<Onset> onset = one ? find_onset(first, base, error, settings, whole, work) : std::nullopt;
    if (onset) out.onset = first.scenario.time[onset->at];
    add_results(onset ? onset->after : whole, base, tuned, onset, out);
    add_motion(motion_by_hypothesis(ready.data, base, out.explanations, out.broken, options.threads), out);
    if (one) out.reading = other_reading(logs.front(), base, trial, settings, out.hypotheses, work);
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
