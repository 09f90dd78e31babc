// `servodx tune LOG...`: nominal parameters from fault-free logs, pooled.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/trouble.h"
#include "base/units.h"
#include "commands.h"
#include "invocation.h"
#include "report/shared/columns.h"
#include "report/shared/conditions.h"
#include "report/shared/json.h"
#include "report/shared/replay_part.h"
#include "report/shared/text_options.h"
#include "report/tune/tune_json.h"
#include "report/tune/tune_page.h"
#include "report/tune/tune_text.h"
#include "report/tune/tune_words.h"
#include "servodx/check_log.h"
#include "servodx/log.h"
#include "servodx/miss.h"
#include "servodx/pages.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "servodx/tune.h"
#include "servodx/watch.h"

namespace servodx {
namespace {

struct Options {
  CommonOptions common;
  std::vector<std::string> logs;
  std::string params, output;
  std::string effects;  // or "none"; empty: as fits the logs
  std::string local = "least_squares", profile;
  std::vector<std::string> priors;
  TuneOptions tune;
  RunOptions run;
};

// What a diagnosis with the tuned table would see on each log. Logs of a test stand are not diagnosed.
std::vector<Promise> promises(const std::vector<Log>& logs, const Tuned& tuned, const RigFile& rig, int threads,
                              Invocation& invocation) {
  std::vector<Promise> all;
  if (tuned.interrupted || rig_kind(logs, rig).on_stand) return all;
  const Watch watch = invocation.watch();
  for (const Log& log : logs) {
    try {
      all.push_back(promise_of(log, tuned.table, rig, threads));
      invocation.header().simulations += all.back().simulations;
    } catch (const InputError& error) {  // the table is written: what is missing is said, and no more
      invocation.note({told(error)});
    }
    watch.tell("faults in sight", static_cast<double>(&log - logs.data() + 1) / static_cast<double>(logs.size()), 0);
  }
  return all;
}

// "piston_area_a=1e-5": standard deviation in the table's unit.
std::map<std::string, double> priors_of(const std::vector<std::string>& list) {
  std::map<std::string, double> priors;
  for (const std::string& text : list) {
    const auto equals = text.find('=');
    const double sd = equals == std::string::npos ? 0 : parse_number(text.substr(equals + 1)).value_or(0);
    require_option(sd > 0 && equals > 0, "--prior", "'" + text + "' is not NAME=SD",
                   "--prior piston_area_a=1e-5: a standard deviation about the table's nominal, in the table's unit");
    priors[text.substr(0, equals)] = sd;
  }
  return priors;
}

int run(const Options& options) {
  TuneOptions tune_options = options.tune;
  if (options.effects == "none")
    tune_options.effects.emplace();
  else if (!options.effects.empty())
    tune_options.effects = CLI::detail::split(options.effects, ',');
  const std::map<std::string, TuneLocal> methods = {
      {"least_squares", TuneLocal::least_squares}, {"ceres", TuneLocal::ceres}, {"nlopt", TuneLocal::nlopt}};
  require_option(methods.contains(options.local), "--local", "unknown method '" + options.local + "'",
                 "use least_squares, ceres or nlopt");
  tune_options.local = methods.at(options.local);
  tune_options.priors = priors_of(options.priors);
  tune_options.profile = CLI::detail::split(options.profile, ',');
  std::erase_if(tune_options.profile, [](const std::string& name) { return name.empty(); });
  tune_options.seed = options.common.seed;
  tune_options.threads = options.common.threads;
  tune_options.validate();

  Invocation invocation("tune", options.common, options.run);
  auto inputs = options.logs;
  inputs.push_back(options.params);
  invocation.check_files(inputs, {options.output});
  const RigFile rig = invocation.rig();
  const Table nominal = invocation.table(options.params);  // tune() applies the facts, effects' rows included
  const std::vector<Log> logs = invocation.logs(options.logs, rig);
  report::add_to_head(invocation.header().head, logs);

  require_profiled_rows(logs, nominal, rig, tune_options);

  report::Header& header = invocation.header();
  *header.settings = {{"population", tune_options.population},
                      {"generations", tune_options.generations},
                      {"heldout", tune_options.heldout},
                      {"moving_average", tune_options.moving_average},
                      // Those asked for stay free; of the default ones the logs decide.
                      {"effects", tune_options.effects.value_or(default_effects(rig_kind(logs, rig)))},
                      {"local", options.local},
                      {"profile", options.profile},
                      {"prior", options.priors}};
  invocation.tell_of_long_fits(logs);
  if (invocation.dry_run()) return ran;

  tune_options.watch = invocation.watch();
  const Tuned tuned = tune(logs, nominal, rig, tune_options);
  write_tuned(options.output, tuned);
  const auto& result = *tuned.whole;

  header.simulations = tuned.simulations;
  header.failed_simulations = tuned.failed_simulations;
  for (const Log& log : logs) invocation.note(log.notes);
  invocation.note(tuned.notes);
  const auto likeliest = likeliest_miss(
      logs, tuned, rig, {.seed = tune_options.seed, .threads = tune_options.threads, .watch = tune_options.watch});
  const report::GoodEnough good = report::good_enough(
      result, promises(logs, tuned, rig, options.common.threads, invocation), likeliest ? &*likeliest : nullptr);
  if (tune_options.watch.stopped()) invocation.note_how_to_go_on();
  if (invocation.wants_report())
    invocation.write_report(
        report::tune_page(header, result, good, replays_of(tuned, logs, rig, report::most_replays)));
  report::Json body = report::tune_json(result);
  body["good_enough"] = report::to_json(good);
  invocation.finish(report::text_of(result, good, {.colour = colour_wanted(), .written_to = options.output}), body);
  return tune_options.watch.stopped() ? interrupted : ran;
}

}  // namespace

void add_tune_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  TuneOptions& tune = options->tune;
  CLI::App* command = app.add_subcommand("tune", "Nominal parameters from fault-free logs, pooled");
  command->add_option("LOG", options->logs, "fault-free rig logs, CSV")->required();
  command->add_option("--params", options->params, "parameter table to begin from, CSV")->required()->type_name("P");
  command->add_option("-o,--output", options->output, "the tuned table")->required()->type_name("TUNED.csv");
  command->add_option("--population", tune.population, "of the genetic search")->type_name("N")->capture_default_str();
  command->add_option("--generations", tune.generations, "of the genetic search")
      ->type_name("N")
      ->capture_default_str();
  command
      ->add_option("--rounds", tune.rounds, "most rounds of the last stage; more where its note says 'iteration limit'")
      ->type_name("N")
      ->capture_default_str();
  command
      ->add_option("--moving-average", tune.moving_average,
                   "smooth measurement and simulation alike, odd number of samples; later commands follow")
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--effects", options->effects, "effects freed beside the table's rows, or 'none'")
      ->type_name("A,B")
      ->default_str(report::join(default_effects({}), ",") +
                    "; supply_droop and return_drop where a log lacks that pressure; on a test stand " +
                    report::join(default_effects({.on_stand = true}), ","));
  command
      ->add_option("--local", options->local,
                   "local stage: least_squares (a search that knows the bounds, then Ceres), ceres alone, or nlopt "
                   "(without derivatives, slower) where friction sticks and slips")
      ->type_name("METHOD")
      ->capture_default_str();
  command->add_option("--profile", options->profile, "check the 95 % intervals of these rows, or 'all', by refitting")
      ->type_name("A,B");
  command
      ->add_option("--prior", options->priors,
                   "hold a row to its nominal, give or take SD in the table's unit; may be repeated")
      ->type_name("NAME=SD");
  add_run_options(*command, options->run);
  add_common_options(*command, options->common);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace servodx
