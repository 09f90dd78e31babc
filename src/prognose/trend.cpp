#include "prognose/trend.h"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <limits>

#include "prognose/cause_rule.h"
#include "prognose/check_series.h"
#include "prognose/check_trend.h"
#include "prognose/constants.h"
#include "servodx/note.h"

namespace servodx {

using namespace prognose_constants;

namespace {

bool stopped(const TrendSettings& options) { return options.stop && options.stop(); }

std::vector<CheckTrend> trends_of(const std::vector<CheckSeries>& checks, const TrendSettings& options) {
  std::vector<CheckTrend> out(checks.size());
  const auto n = static_cast<long>(checks.size());
  const int threads = options.threads > 0 ? options.threads : omp_get_max_threads();
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
  for (long k = 0; k < n; ++k)
    if (!stopped(options))
      out[static_cast<std::size_t>(k)] = trend_of(checks[static_cast<std::size_t>(k)], options, checks.size());
  return out;
}

// What a user may have meant otherwise with a level.
void note_levels(ValveTrend& out, const std::vector<CheckSeries>& checks, const TrendSettings& options) {
  for (const CheckSeries& s : checks)
    if (options.failure_current.contains(s.name) && !s.per_newton)
      out.notes.push_back({Note::Kind::failure_level,
                           fmt::format("{}: no tuned table says what friction takes that current", s.name.text())});
  for (std::size_t k = 0; k < checks.size(); ++k) {
    const CheckTrend& t = out.trends[k];
    if (t.failure.passed_by(t.healthy))
      out.notes.push_back(
          {Note::Kind::failure_level, t.name.text() + ": its first checks are beyond its failure level already"});
    if (options.failure_ratio.contains(t.name) && checks[k].fault && !checks[k].fault->log_scale)
      out.notes.push_back({Note::Kind::failure_level,
                           t.name.text() + ": does not multiply, so its level is so many times its first checks"});
  }
}

void note_blind(ValveTrend& out) {
  for (const CheckTrend& t : out.trends)
    if (t.blind && !t.trend)
      out.notes.push_back(
          {Note::Kind::blind,
           fmt::format(
               "{}: a healthy check scatters beyond the failure level at this false-alarm rate; only a trend can warn",
               t.name.text())});
}

void note_unknown(ValveTrend& out) {
  for (const CheckTrend& t : out.trends)
    if (t.state == TrendState::unknown && t.points.size() >= least_checks)
      out.notes.push_back(
          {Note::Kind::implausible,
           t.name.text() + ": holds a reading that none can be, 0 or less of a ratio: no word on a trend"});
  if (out.state == TrendState::unknown && out.checks < least_checks)
    out.notes.push_back(
        {Note::Kind::few_checks, fmt::format("fewer than {} checks: no word on a trend", least_checks)});
}

// A valve has come as far as the check that has come furthest.
void take_state(ValveTrend& out) {
  for (const CheckTrend& t : out.trends) {
    out.state = std::max(out.state, t.state);
    out.to_warning = std::min(out.to_warning, t.to_warning);
    if (t.alert_at && (!out.alert_at || *t.alert_at < *out.alert_at)) out.alert_at = t.alert_at;
  }
}

void take_cause_and_life(ValveTrend& out, double coverage) {
  std::vector<CauseEvidence> evidence;
  for (const CheckTrend& t : out.trends)
    evidence.push_back({!t.cause.empty(), t.trend && !t.life.empty(), t.surely, t.log_bayes_factor});
  const auto cause = cause_of(evidence);
  std::vector<const Life*> lives;
  if (cause) {
    out.cause = out.trends[*cause].cause;
    lives.push_back(&out.trends[*cause].life);
  } else {
    for (const CheckTrend& t : out.trends)
      if (!t.life.empty() && t.cause.empty()) lives.push_back(&t.life);
  }
  if (lives.empty()) return;
  out.life = pooled(lives, coverage);
  out.remaining = remaining_of(out.life, coverage);
}

}  // namespace

ValveTrend trend(const ValveHistory& history, const TrendSettings& options) {
  ValveTrend out;
  out.valve = history.valve;
  out.serial = history.serial;
  out.checks = history.recordings.size();
  out.at = history.recordings.empty() ? 0.0 : history.recordings.back().at;
  out.to_warning = std::numeric_limits<double>::infinity();
  SeriesOfValve series = series_of(history);
  if (series.of_other_tables > 0)
    out.notes.push_back({Note::Kind::other_table, fmt::format("{} checks rest on another tuned table and are left out",
                                                              series.of_other_tables)});
  for (CheckSeries& s : series.checks)
    take_seeded(s, options.seeded), take_clean(s, static_cast<std::size_t>(options.healthy));
  out.trends = trends_of(series.checks, options);
  if (stopped(options)) {
    out.trends.clear();
    out.notes.push_back({Note::Kind::interrupted, "interrupted: no check was judged"});
    return out;
  }
  note_levels(out, series.checks, options);
  take_state(out);
  take_cause_and_life(out, options.coverage);
  note_blind(out);
  note_unknown(out);
  return out;
}

}  // namespace servodx
