// The front door of `trend`.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "base/require_setting.h"
#include "base/units.h"
#include "parameters/list.h"
#include "prognose/check_name.h"
#include "prognose/life.h"
#include "prognose/performance_limits.h"
#include "prognose/seeded.h"
#include "prognose/trend.h"
#include "prognose/trend_options.h"
#include "prognose/trend_state.h"
#include "report/trend/trend_words.h"
#include "servodx/history.h"
#include "servodx/trend.h"
#include "servodx/tune.h"
#include "store/history.h"
#include "store/seeded_csv.h"

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
  require_setting(level.value > 0, "--failure", fmt::format("the level of {} is not above 0", level.check),
                  "give a level in the check's unit");
  require_setting(level.kind != FailureLevel::Kind::current || name.row() == row::spool_friction, "--failure",
                  "a current is a level of the spool's friction alone", "name parameter:14");
  require_setting(!level.spread || *level.spread > 0, "--failure",
                  fmt::format("the spread of {} is not above 0", level.check), "leave it out where it is not known");
}

bool is_check(const CheckName& name) {
  return name.kind() == CheckKind::parameter ? name.row().has_value() : name.kind() != CheckKind::other;
}

// What is no check may be a figure of another origin, that the history was given.
void require_checks(const std::vector<FailureLevel>& levels, const History& history) {
  for (const FailureLevel& level : levels) {
    if (is_check(level.check)) continue;
    const std::vector<std::string> held = figures_of(history);
    if (std::find(held.begin(), held.end(), level.check) == held.end()) require_check(level.check);
  }
}

void add_level(const FailureLevel& level, TrendSettings& to) {
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

TrendSettings settings_of(const TrendOptions& options) {
  TrendSettings to;
  to.false_alarm = options.false_alarm, to.healthy = options.healthy, to.coverage = options.coverage;
  to.seed = options.seed, to.threads = options.threads, to.stop = options.watch.stop;
  for (const FailureLevel& level : options.limits) add_level(level, to);
  for (const FailureLevel& level : options.failures) add_level(level, to);
  if (options.seeded) to.seeded = options.seeded->readings;
  return to;
}

}  // namespace

void TrendOptions::validate() const {
  require_setting(false_alarm > 0 && false_alarm < 0.5, "--false-alarm", "is a rate between 0 and 0.5",
                  "0.01 is one healthy valve in a hundred");
  require_setting(healthy >= 5, "--healthy", "needs at least 5 checks", "levels rest on them");
  require_setting(coverage > 0 && coverage < 1, "--coverage", "is between 0 and 1", "0.9");
  require_threads(threads);
  for (const FailureLevel& level : failures) require_level(level);
  for (const FailureLevel& level : limits)
    require_setting(is_check(level.check) && std::isfinite(level.value) && (!level.spread || *level.spread > 0),
                    "TrendOptions.limits", "'" + level.check + "' is no check, or its level no number",
                    "take what failure_levels() gives");
}

void require_check(const std::string& name) {
  require_setting(
      is_check(name), "--failure", "'" + name + "' is no check",
      fmt::format("use mean_error, fidelity, correlation@5Hz or parameter:1 to parameter:{}", n_parameters));
}

FailureLevel failure_level(const std::string& words) {
  const auto equals = words.find('=');
  FailureLevel out{.check = words.substr(0, equals)};
  std::string level = equals == std::string::npos ? "" : words.substr(equals + 1);
  const bool below = level.starts_with('<');
  if (below) level.erase(0, 1);
  const auto tilde = level.find('~');
  if (tilde != std::string::npos) out.spread = parse_number(level.substr(tilde + 1)), level.erase(tilde);
  const bool times = level.ends_with('x');
  if (times) level.pop_back();
  const bool current = level.ends_with('A');
  if (current) level.pop_back();
  const std::optional<double> value = parse_number(level);
  require_setting(
      value && *value > 0 && equals > 0 && (tilde == std::string::npos || (out.spread && *out.spread > 0)) &&
          !((times || current) && below) && !(current && CheckName(out.check).row() != row::spool_friction),
      "--failure", "'" + words + "' is not NAME=VALUE above 0",
      "--failure fidelity=1.7, --failure 'parameter:3=<20' for a lower limit, --failure parameter:14=20x for "
      "20 times the tuned value, parameter:14=0.9e-3A for the current that the spool's friction takes, ~SPREAD "
      "behind it for how well it is known");
  out.value = *value;
  out.kind = times     ? FailureLevel::Kind::times_healthy
             : current ? FailureLevel::Kind::current
             : below   ? FailureLevel::Kind::below
                       : FailureLevel::Kind::above;
  return out;
}

std::vector<FailureLevel> failure_levels(const std::vector<std::string>& limits, const Tuned& tuned, double loop) {
  TrendSettings set;
  std::vector<PerformanceLimit> read;
  for (const std::string& text : limits) read.push_back(read_limit(text));
  for (const PerformanceLimit& limit : read) add_limit(limit, tuned.table, loop, set);
  std::vector<FailureLevel> out;
  for (const auto& [name, levels] : set.failure) {
    if (levels.first) out.push_back({name.text(), FailureLevel::Kind::below, *levels.first, {}});
    if (levels.second) out.push_back({name.text(), FailureLevel::Kind::above, *levels.second, {}});
  }
  for (const auto& [name, ratio] : set.failure_ratio)
    out.push_back({name.text(), FailureLevel::Kind::times_healthy, ratio, {}});
  return out;
}

std::shared_ptr<const SeededTest> read_seeded_test(const std::string& path) {
  return std::make_shared<SeededTest>(SeededTest{read_seeded_csv(path)});
}

std::string name_of(Trend::State state) {
  for (const TrendState s : {TrendState::unknown, TrendState::blind, TrendState::healthy, TrendState::watch,
                             TrendState::warning, TrendState::failed})
    if (state_of(s) == state) return report::word_of(s);
  return "";
}

Trend trend(const History& history, const std::string& valve, const TrendOptions& options) {
  options.validate();
  require_checks(options.failures, history);
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

void most_urgent_first(std::vector<Trend>& trends) {
  const auto urgency = [](const Trend& t) {
    return std::pair(t.whole->to_warning, t.remaining ? t.remaining->median : std::numeric_limits<double>::infinity());
  };
  std::stable_sort(trends.begin(), trends.end(),
                   [&](const Trend& a, const Trend& b) { return urgency(a) < urgency(b); });
}

}  // namespace servodx
