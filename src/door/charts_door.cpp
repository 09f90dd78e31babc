// The front door of charts: what replays, trends and tunes hold beside their results.
#include <utility>

#include "fit/candidate_of.h"
#include "fit/log_data.h"
#include "fit/replay.h"
#include "prognose/level.h"
#include "prognose/trend.h"
#include "report/tune/tune_words.h"
#include "servodx/charts.h"
#include "servodx/data_sheet.h"
#include "servodx/log.h"
#include "servodx/replay.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "servodx/trend.h"
#include "servodx/tune.h"
#include "tune/tune.h"

namespace servodx {
namespace {

TrendChart::Range range_of(const Level& level) { return {level.lower, level.upper}; }

}  // namespace

LogChart chart_of(const Log& log, const Table& table, const Rig& rig) {
  require_channels(prepare(log, rig));
  Replay run = replay(log, table, rig, {{"table", candidate_of(apply_rig_facts(table, rig))}});
  LogChart out{run.log, std::move(run.time), std::move(run.command), {}};
  for (ReplayedChannel& c : run.channels) {
    out.signals.push_back({c.signal, c.unit, std::move(c.measured), {}, {}, std::move(c.sigma)});
    if (c.simulated.empty()) continue;
    out.signals.back().simulated = std::move(c.simulated.front().value);
    out.signals.back().residual = std::move(c.simulated.front().residual);
  }
  return out;
}

TrendChart chart_of(const Trend& trend) {
  TrendChart out;
  if (!trend.whole) return out;
  out.life = trend.whole->life;
  for (const CheckTrend& t : trend.whole->trends) {
    TrendChart::OfCheck& of = out.checks.emplace_back();
    of.name = t.name.text(), of.unit = t.unit, of.cause = t.cause;
    for (const CheckTrend::Point& p : t.points) of.points.push_back({p.at, p.value, p.temperature, p.healthy});
    of.threshold = range_of(t.threshold), of.warning = range_of(t.warning), of.failure = range_of(t.failure);
    of.healthy = t.healthy, of.now = t.now, of.slope = t.slope, of.grows = t.trend;
    of.life = t.life;
  }
  return out;
}

TuneChart chart_of(const Tuned& tuned) {
  TuneChart out;
  if (!tuned.whole) return out;
  for (const ConvergencePoint& p : tuned.whole->convergence)
    out.convergence.push_back({report::word_of(p.stage), p.simulations, p.cost});
  for (const StartEnd& start : tuned.whole->starts) out.starts.push_back(start.cost);
  return out;
}

}  // namespace servodx
