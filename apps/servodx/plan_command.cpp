// `servodx plan`: the excitation that tells most, within limits, and what it would show.
#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/units.h"
#include "baseline_beside.h"
#include "commands.h"
#include "invocation.h"
#include "report/plan/plan.h"
#include "report/shared/json.h"
#include "servodx/baseline.h"
#include "servodx/log.h"
#include "servodx/plan.h"
#include "servodx/rig.h"
#include "servodx/tune.h"

namespace servodx {
namespace {

struct Options {
  CommonOptions common;
  std::string params, baseline, like, output, random;
  std::vector<std::string> faults, between;
  std::string stroke, speed, pressure;
  double loop_gain = 0;  // [mA/mm]
  bool closed_loop = false;
  PlanOptions plan;
};

// "NAME" or "NAME=SEVERITY".
std::vector<PlanFault> faults_of(const std::vector<std::string>& words, const std::string& option) {
  std::vector<PlanFault> out;
  for (const std::string& word : words) {
    const auto equals = word.find('=');
    PlanFault fault{word.substr(0, equals)};
    if (equals != std::string::npos) {
      const auto severity = parse_number(word.substr(equals + 1));
      require_option(severity.has_value(), option, "'" + word + "' has no number behind '='",
                     "write NAME=SEVERITY, in the unit that 'servodx list faults' shows");
      fault.severity = *severity;
    }
    out.push_back(fault);
  }
  return out;
}

std::optional<double> limit_of(const std::string& text, Dimension dimension, const std::string& option) {
  if (text.empty()) return {};
  return parse_quantity(text, dimension, {option, 0, ""}).value;
}

// Speeds have no unit of their own at the boundary: a way in a second.
std::optional<double> speed_of(std::string text) {
  if (text.empty()) return {};
  constexpr std::string_view in_a_second = "/s";
  require_option(text.ends_with(in_a_second), "--max-speed", "'" + text + "' is no speed", "write it as '300 mm/s'");
  text.resize(text.size() - in_a_second.size());
  return parse_quantity(text, Dimension::length, {"--max-speed", 0, ""}).value;
}

PlanOptions wishes(const Options& options) {
  PlanOptions how = options.plan;
  how.faults = faults_of(options.faults, "--faults");
  how.between = faults_of(options.between, "--between");
  how.limits.stroke = limit_of(options.stroke, Dimension::length, "--max-stroke");
  how.limits.speed = speed_of(options.speed);
  how.limits.pressure = limit_of(options.pressure, Dimension::pressure, "--max-pressure");
  constexpr double amperes_a_metre = 1.0;  // mA/mm
  if (options.closed_loop) how.loop_gain = options.loop_gain * amperes_a_metre;
  how.seed = options.common.seed;
  how.threads = options.common.threads;
  how.validate();
  return how;
}

report::Json settings_of(const Options& o) {
  return {{"faults", o.faults},
          {"between", o.between},
          {"rows", o.plan.rows},
          {"seconds", o.plan.seconds},
          {"rate", o.plan.rate},
          {"max_current", o.plan.limits.current},
          {"max_stroke", o.stroke},
          {"max_speed", o.speed},
          {"max_pressure", o.pressure},
          {"closed_loop", o.closed_loop ? report::Json(o.loop_gain) : report::Json(nullptr)},
          {"rounds", o.plan.rounds},
          {"baseline", o.baseline},
          {"like", o.like}};
}

int run(const Options& options) {
  PlanOptions how = wishes(options);
  Invocation invocation("plan", options.common);
  std::vector<std::string> inputs = {options.params}, outputs = {options.output};
  for (const std::string& file : {options.baseline, options.like})
    if (!file.empty()) inputs.push_back(file);
  if (!options.random.empty()) outputs.push_back(options.random);
  invocation.check_files(inputs, outputs);
  const RigFile rig = invocation.rig();
  const Tuned tuned = invocation.tuned(options.params);
  report::Header& header = invocation.header();
  std::optional<Baseline> baseline;
  if (!options.baseline.empty()) {
    baseline = baseline_beside(invocation, options.baseline, rig);
    require_same_table(*baseline, tuned);
    header.inputs.push_back({options.baseline, baseline->sha256});
  }
  std::optional<Log> like;
  if (!options.like.empty()) like = invocation.log(options.like, rig);
  *header.settings = settings_of(options);
  if (invocation.dry_run()) return ran;

  how.watch = invocation.watch();
  const PlannedTest test = plan_test(tuned, rig, how, baseline ? &*baseline : nullptr, like ? &*like : nullptr);
  write_command(options.output, test);
  if (!options.random.empty()) write_random_command(options.random, test);
  header.simulations = test.simulations;
  header.failed_simulations = test.failed_simulations;
  invocation.note(test.notes);
  if (invocation.wants_report()) invocation.write_report(report::plan_page(header, test));
  report::Json body = report::plan_json(test);
  body["output"] = options.output;
  invocation.finish(report::text_of(test, options.output), body);
  return test.interrupted ? interrupted : ran;
}

void add_limits(CLI::App& command, Options& options) {
  command.add_option("--max-current", options.plan.limits.current, "largest current, fraction of the rated current")
      ->capture_default_str();
  command.add_option(
      "--max-stroke", options.stroke,
      "how far the piston may go from where it starts: '50 mm'; without: three quarters of the way to its "
      "stop");
  command.add_option("--max-speed", options.speed, "of the piston: '300 mm/s'; without: any");
  command.add_option("--max-pressure", options.pressure, "in either chamber: '180 bar'; without: any");
}

}  // namespace

void add_plan_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("plan", "The excitation that tells most, within limits, and what it would show");
  command->add_option("--params", options->params, "tuned table")->required()->type_name("TUNED");
  command->add_option("--faults", options->faults, "to be found and named: NAME or NAME=SEVERITY; without: all")
      ->delimiter(',')
      ->type_name("A,B");
  command->add_option("--between", options->between, "two faults, to be distinguished: NAME or NAME=SEVERITY")
      ->delimiter(',')
      ->type_name("A,B");
  command->add_option("--rows", options->plan.rows, "rows of the table, to be estimated")
      ->delimiter(',')
      ->type_name("R");
  command->add_option("--seconds", options->plan.seconds, "length of the test [s]")->capture_default_str();
  command->add_option("--rate", options->plan.rate, "samples of the command a second [Hz]")->capture_default_str();
  add_limits(*command, *options);
  CLI::Option* loop = command->add_option(
      "--closed-loop", options->loop_gain,
      "the test is played as the setpoint of a proportional position loop of this gain [mA/mm]; without: as current");
  command->add_option("--baseline", options->baseline, "its baseline: the limit that a finding has to pass")
      ->type_name("BASE.json");
  command->add_option("--like", options->like, "a log of the rig: its operating point, its sensors and their noise")
      ->type_name("LOG");
  command->add_option("--rounds", options->plan.rounds, "of exchange; more take longer")->capture_default_str();
  command->add_option("-o,--output", options->output, "the command to play, CSV")->required()->type_name("COMMAND.csv");
  command->add_option("--random", options->random, "also write a random test as long and within the same limits")
      ->type_name("RANDOM.csv");
  add_common_options(*command, options->common);
  command->callback([options, loop, &exit_code] {
    options->closed_loop = loop->count() > 0;
    exit_code = run(*options);
  });
}

}  // namespace servodx
