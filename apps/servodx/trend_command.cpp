// `servodx trend`: a valve's state, the levels its checks have reached and the life left; or a fleet's ranking.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>

#include "base/atomic_file.h"
#include "base/sha256.h"
#include "base/units.h"
#include "commands.h"
#include "fleet/prometheus.h"
#include "invocation.h"
#include "parameters/list.h"
#include "prognose/check.h"
#include "prognose/check_name.h"
#include "prognose/life.h"
#include "prognose/performance_limits.h"
#include "prognose/trend.h"
#include "prognose/trend_options.h"
#include "prognose/valve_history.h"
#include "report/trend/trend_report.h"
#include "report/trend/trend_words.h"
#include "servodx/table.h"
#include "store/history.h"
#include "store/seeded_csv.h"

namespace servodx {
namespace {

struct Options {
  CommonOptions common;
  std::string history, valve, params, seeded, prometheus;
  std::vector<std::string> failures, limits;
  double loop = 0;  // [1/s]
  bool all = false;
  TrendSettings trend;
};

// "fidelity=1.7" above, "parameter:3=<20" below; "parameter:14=20x" times the tuned value (of the paper's checks: the
// healthy one); "parameter:14=0.9e-3A" the current that the spool's friction takes; "parameter:22=30e-6~1e-6" known to
// one standard deviation.
void add_failure(const std::string& text, TrendSettings& to) {
  const auto equals = text.find('=');
  const CheckName name = text.substr(0, equals);
  std::string level = equals == std::string::npos ? "" : text.substr(equals + 1);
  const bool below = level.starts_with('<');
  if (below) level.erase(0, 1);
  std::optional<double> spread;
  const auto tilde = level.find('~');
  if (tilde != std::string::npos) spread = parse_number(level.substr(tilde + 1)), level.erase(tilde);
  const bool times = level.ends_with('x');
  if (times) level.pop_back();
  const bool current = level.ends_with('A');
  if (current) level.pop_back();
  const std::optional<double> value = parse_number(level);
  require_option(
      value && *value > 0 && equals > 0 && (tilde == std::string::npos || (spread && *spread > 0)) &&
          !((times || current) && below) && !(current && name.row() != row::spool_friction),
      "--failure", "'" + text + "' is not NAME=VALUE above 0",
      "--failure fidelity=1.7, --failure 'parameter:3=<20' for a lower limit, --failure parameter:14=20x for "
      "20 times the tuned value, parameter:14=0.9e-3A for the current that the spool's friction takes, ~SPREAD "
      "behind it for how well it is known");
  if (spread) to.failure_spread[name] = *spread;
  if (times)
    to.failure_ratio[name] = *value;
  else if (current)
    to.failure_current[name] = *value;
  else
    (below ? to.failure[name].first : to.failure[name].second) = *value;
}

// What checks are called; of the rest, what is only not in this history is told.
void require_levels_of_checks(const std::vector<std::string>& failures, const std::set<CheckName>& held,
                              Invocation& invocation) {
  for (const std::string& text : failures) {
    const CheckName name = text.substr(0, text.find('='));
    if (held.contains(name)) continue;
    const bool known = name.kind() == CheckKind::parameter ? name.row().has_value() : name.kind() != CheckKind::other;
    require_option(
        known, "--failure", "'" + name.text() + "' is no check",
        fmt::format("use mean_error, fidelity, correlation@5Hz or parameter:1 to parameter:{}", n_parameters));
    invocation.note({name.text() + ": no check of this history reads it; its failure level changes nothing"});
  }
}

std::vector<LifeGauge> gauges_of(const std::vector<ValveTrend>& trends) {
  std::vector<LifeGauge> out;
  for (const ValveTrend& t : trends) {
    const Remaining unknown{NAN, NAN, NAN}, left = t.remaining.value_or(unknown);
    out.push_back({t.valve, report::word_of(t.state), left.median, left.lower, left.upper});
  }
  return out;
}

void run(Options options) {
  require_option(options.all != !options.valve.empty(), "--valve", "name one valve, or --all", "give one of the two");
  require_option(options.trend.false_alarm > 0 && options.trend.false_alarm < 0.5, "--false-alarm",
                 "is a rate between 0 and 0.5", "0.01 is one healthy valve in a hundred");
  require_option(options.trend.healthy >= 5, "--healthy", "needs at least 5 checks", "levels rest on them");
  require_option(options.trend.coverage > 0 && options.trend.coverage < 1, "--coverage", "is between 0 and 1", "0.9");
  options.trend.seed = options.common.seed;
  options.trend.threads = options.common.threads;
  Invocation invocation("trend", options.common);
  std::vector<std::string> inputs = {options.history};
  for (const std::string& file : {options.params, options.seeded})
    if (!file.empty()) inputs.push_back(file);
  std::vector<std::string> outputs;
  if (!options.prometheus.empty()) outputs.push_back(options.prometheus);
  invocation.check_files(inputs, outputs);
  require_option(options.limits.empty() || !options.params.empty(), "--limit", "needs the tuned table",
                 "--params TUNED");
  if (!options.params.empty()) {
    const Table tuned = invocation.tuned_table(options.params);
    for (const std::string& text : options.limits) add_limit(read_limit(text), tuned, options.loop, options.trend);
  }
  for (const std::string& text : options.failures) add_failure(text, options.trend);
  if (!options.seeded.empty()) {
    options.trend.seeded = read_seeded_csv(options.seeded);
    invocation.header().inputs.push_back({options.seeded, sha256_of_file(options.seeded)});
  }
  const HistoryFile history(options.history, false);
  std::optional<ValveHistory> one;
  std::set<CheckName> held;
  if (options.all) {
    if (!options.failures.empty())
      for (const std::string& name : history.figures()) held.insert(name);
  } else {
    one = history.of(options.valve);  // refuses a name that is not there
    for (const Recording& r : one->recordings)
      for (const Check& c : r.checks) held.insert(c.name);
  }
  require_levels_of_checks(options.failures, held, invocation);
  *invocation.header().settings = {{"history", options.history},       {"false_alarm", options.trend.false_alarm},
                                   {"healthy", options.trend.healthy}, {"coverage", options.trend.coverage},
                                   {"failure", options.failures},      {"limit", options.limits},
                                   {"seeded", options.seeded}};
  if (invocation.dry_run()) return;

  std::vector<ValveTrend> trends;
  for (const std::string& name : options.all ? history.valves() : std::vector<std::string>{options.valve}) {
    trends.push_back(trend(one ? *one : history.of(name), options.trend));
    invocation.note(trends.back().notes);
  }
  // The first to warn first; of those that have passed it, the first to fail.
  const auto urgency = [](const ValveTrend& v) {
    return std::pair(v.to_warning, v.remaining ? v.remaining->median : std::numeric_limits<double>::infinity());
  };
  std::stable_sort(trends.begin(), trends.end(),
                   [&](const ValveTrend& a, const ValveTrend& b) { return urgency(a) < urgency(b); });
  if (!options.prometheus.empty()) write_file(options.prometheus, text_of(gauges_of(trends)));
  if (invocation.wants_report()) invocation.write_report(report::trend_page(invocation.header(), trends, options.all));
  invocation.finish(options.all ? report::ranking(trends) : report::text_of(trends.front()),
                    report::trend_json(trends, options.all));
}

}  // namespace

void add_trend_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("trend", "Warning, failure and remaining useful life from a history");
  command->add_option("--history", options->history, "history file")->required()->type_name("H.db");
  command->add_option("--valve", options->valve, "one valve")->type_name("ID");
  command->add_flag("--all", options->all, "all valves, the first to reach its warning level first");
  command
      ->add_option("--prometheus", options->prometheus,
                   "text for Prometheus' textfile collector: state and life left of each valve")
      ->type_name("FILE.prom");
  command
      ->add_option("--failure", options->failures,
                   "failure level of a check: NAME=VALUE, NAME=<VALUE below, NAME=20x times the tuned value, "
                   "parameter:14=0.9e-3A the current that the spool's friction takes")
      ->type_name("NAME=VALUE");
  command
      ->add_option("--limit", options->limits,
                   "performance limit that sets failure levels: bandwidth, gain, hysteresis, "
                   "phase_margin, or margin=6dB (or deg) of the position loop for every degradation")
      ->type_name("NAME=VALUE");
  command
      ->add_option("--seeded", options->seeded,
                   "what checks of valves with wear of known size read: valve, name, truth, value, oil_temperature "
                   "[degC]; parameters are taken to the wear at which these read the same")
      ->type_name("TEST.csv");
  command->add_option("--params", options->params, "tuned table, for --limit")->type_name("TUNED");
  command->add_option("--loop", options->loop, "velocity gain of the position loop, for its margins [1/s]")
      ->type_name("GAIN");
  command->add_option("--false-alarm", options->trend.false_alarm, "part of healthy valves that may raise an alert")
      ->type_name("RATE")
      ->capture_default_str();
  command->add_option("--healthy", options->trend.healthy, "first checks taken as healthy")
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--coverage", options->trend.coverage, "of the interval of the life left")
      ->type_name("PART")
      ->capture_default_str();
  add_common_options(*command, options->common);
  command->callback([options] { run(*options); });
}

}  // namespace servodx
