// `servodx trend`: a valve's state, the levels its checks have reached and the life left; or a fleet's ranking.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/sha256.h"
#include "commands.h"
#include "invocation.h"
#include "report/trend/life_gauges.h"
#include "report/trend/trend_report.h"
#include "servodx/history.h"
#include "servodx/trend.h"

namespace servodx {
namespace {

struct Options {
  CommonOptions common;
  std::string history, valve, params, seeded, prometheus;
  std::vector<std::string> failures, limits;
  double loop = 0;  // [1/s]
  bool all = false;
  TrendOptions trend;
};

// What checks are called; of the rest, what is only not in this history is told.
void require_levels_of_checks(const std::vector<std::string>& failures, const std::vector<std::string>& held,
                              Invocation& invocation) {
  for (const std::string& text : failures) {
    const std::string name = text.substr(0, text.find('='));
    if (std::find(held.begin(), held.end(), name) != held.end()) continue;
    require_check(name);
    invocation.note({name + ": no check of this history reads it; its failure level changes nothing"});
  }
}

void run(Options options) {
  require_option(options.all != !options.valve.empty(), "--valve", "name one valve, or --all", "give one of the two");
  options.trend.seed = options.common.seed;
  options.trend.threads = options.common.threads;
  options.trend.validate();
  Invocation invocation("trend", options.common);
  std::vector<std::string> inputs = {options.history};
  for (const std::string& file : {options.params, options.seeded})
    if (!file.empty()) inputs.push_back(file);
  std::vector<std::string> outputs;
  if (!options.prometheus.empty()) outputs.push_back(options.prometheus);
  invocation.check_files(inputs, outputs);
  require_option(options.limits.empty() || !options.params.empty(), "--limit", "needs the tuned table",
                 "--params TUNED");
  if (!options.params.empty())
    options.trend.limits = failure_levels(options.limits, invocation.tuned(options.params), options.loop);
  for (const std::string& text : options.failures) options.trend.failures.push_back(failure_level(text));
  if (!options.seeded.empty()) {
    options.trend.seeded = read_seeded_test(options.seeded);
    invocation.header().inputs.push_back({options.seeded, sha256_of_file(options.seeded)});
  }
  const History history = History::open(options.history);
  std::vector<std::string> held;
  if (!options.all)
    held = figures_of(history, options.valve);  // refuses a name that is not there
  else if (!options.failures.empty())
    held = figures_of(history);
  require_levels_of_checks(options.failures, held, invocation);
  *invocation.header().settings = {{"history", options.history},       {"false_alarm", options.trend.false_alarm},
                                   {"healthy", options.trend.healthy}, {"coverage", options.trend.coverage},
                                   {"failure", options.failures},      {"limit", options.limits},
                                   {"seeded", options.seeded}};
  if (invocation.dry_run()) return;

  std::vector<Trend> trends;
  for (const std::string& name : options.all ? history.valves() : std::vector<std::string>{options.valve}) {
    trends.push_back(trend(history, name, options.trend));
    invocation.note(trends.back().notes);
  }
  most_urgent_first(trends);
  if (!options.prometheus.empty()) write_file(options.prometheus, report::life_gauges(trends));
  if (invocation.wants_report()) invocation.write_report(report::trend_page(invocation.header(), trends, options.all));
  invocation.finish(options.all ? report::ranking(trends) : report::text_of(*trends.front().whole),
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
