// The front door of `trend`.
#include <fmt/format.h>

#include <memory>
#include <utility>

#include "door/require_setting.h"
#include "parameters/list.h"
#include "prognose/check_name.h"
#include "prognose/life.h"
#include "prognose/trend.h"
#include "prognose/trend_options.h"
#include "prognose/trend_state.h"
#include "report/trend/trend_words.h"
#include "servodx/trend.h"
#include "store/history.h"

namespace servodx {
namespace {

Trend::State state_of(TrendState state) {
  switch (state) {
    case TrendState::unknown:
      return Trend::State::unknown;
    case TrendState::blind:
      return Trend::State::blind;
    case TrendState::healthy:
      return Trend::State::healthy;
    case TrendState::watch:
      return Trend::State::watch;
    case TrendState::warning:
      return Trend::State::warning;
    case TrendState::failed:
      return Trend::State::failed;
  }
  return Trend::State::unknown;
}

std::optional<Trend::Remaining> remaining_of(const std::optional<Remaining>& r) {
  if (!r) return {};
  return Trend::Remaining{r->median, r->lower, r->upper};
}

void require_level(const FailureLevel& level) {
  const CheckName name = level.check;
  const bool known = name.kind() == CheckKind::parameter ? name.row().has_value() : name.kind() != CheckKind::other;
  door::require_setting(
      known, "--failure", "'" + level.check + "' is no check",
      fmt::format("use mean_error, fidelity, correlation@5Hz or parameter:1 to parameter:{}", n_parameters));
  door::require_setting(level.value > 0, "--failure", fmt::format("the level of {} is not above 0", level.check),
                        "give a level in the check's unit");
  door::require_setting(level.kind != FailureLevel::Kind::current || name.row() == row::spool_friction, "--failure",
                        "a current is a level of the spool's friction alone", "name parameter:14");
  door::require_setting(!level.spread || *level.spread > 0, "--failure",
                        fmt::format("the spread of {} is not above 0", level.check),
                        "leave it out where it is not known");
}

TrendSettings settings_of(const TrendOptions& options) {
  TrendSettings to;
  to.false_alarm = options.false_alarm, to.healthy = options.healthy, to.coverage = options.coverage;
  to.seed = options.seed, to.threads = options.threads;
  for (const FailureLevel& level : options.failures) {
    const CheckName name = level.check;
    if (level.spread) to.failure_spread[name] = *level.spread;
    switch (level.kind) {
      case FailureLevel::Kind::above:
        to.failure[name].second = level.value;
        break;
      case FailureLevel::Kind::below:
        to.failure[name].first = level.value;
        break;
      case FailureLevel::Kind::times_healthy:
        to.failure_ratio[name] = level.value;
        break;
      case FailureLevel::Kind::current:
        to.failure_current[name] = level.value;
        break;
    }
  }
  return to;
}

}  // namespace

void TrendOptions::validate() const {
  using door::require_setting;
  require_setting(false_alarm > 0 && false_alarm < 0.5, "--false-alarm", "is a rate between 0 and 0.5",
                  "0.01 is one healthy valve in a hundred");
  require_setting(healthy >= 5, "--healthy", "needs at least 5 checks", "levels rest on them");
  require_setting(coverage > 0 && coverage < 1, "--coverage", "is between 0 and 1", "0.9");
  door::require_threads(threads);
  for (const FailureLevel& level : failures) require_level(level);
}

std::string name_of(Trend::State state) {
  for (const TrendState s : {TrendState::unknown, TrendState::blind, TrendState::healthy, TrendState::watch,
                             TrendState::warning, TrendState::failed})
    if (state_of(s) == state) return report::word_of(s);
  return "";
}

Trend trend(const History& history, const std::string& valve, const TrendOptions& options) {
  options.validate();
  auto found = std::make_shared<ValveTrend>(trend(history.file().of(valve), settings_of(options)));
  Trend out;
  out.valve = found->valve, out.serial = found->serial;
  out.state = state_of(found->state);
  out.at = found->at, out.checks = found->checks;
  out.cause = found->cause.value_or("");
  out.alert_at = found->alert_at;
  out.remaining = remaining_of(found->remaining);
  for (const CheckTrend& t : found->trends)
    out.trends.push_back({t.name.text(), t.unit, state_of(t.state), t.slope, t.alert_at, remaining_of(t.remaining)});
  out.notes = found->notes;
  out.whole = std::move(found);
  return out;
}

}  // namespace servodx
