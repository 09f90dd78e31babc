#include "rig_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "base/atomic_file.h"
#include "base/celsius.h"
#include "base/progress.h"
#include "base/result_schema.h"
#include "base/sha256.h"
#include "invocation.h"
#include "report/shared/columns.h"
#include "report/shared/json.h"
#include "report/shared/plain_page.h"
#include "rig/excitations.h"
#include "rig/facts.h"
#include "rig/fluid.h"
#include "rig/labelled_fleet.h"
#include "rig/played.h"
#include "rig/rig_faults.h"
#include "rig/rig_model.h"
#include "rig/rig_run.h"
#include "servodx/log.h"

namespace servodx {
namespace fs = std::filesystem;
namespace {

struct Options {
  CommonOptions common;
  std::string model = "params/rigs/borello2009.toml";
  std::string output, folder;
  std::optional<double> celsius;  // empty: 40 degC, or a fleet's own
  std::optional<double> duration;
  std::optional<std::string> excitation;
  std::string command;              // file to play; empty: an excitation
  std::optional<double> loop_gain;  // [mA/mm]
  std::optional<double> rate;
  std::vector<std::string> faults, changes;
  std::uint64_t valve = 0;
  rig::RigRun run;
  rig::FleetOptions fleet;
  bool facts = false;
  std::string torque;
};

// LOG.csv -> LOG.truth.json
std::string truth_path(const std::string& log) {
  const auto dot = log.rfind('.');
  const auto slash = log.find_last_of('/');
  const bool has_extension = dot != std::string::npos && (slash == std::string::npos || dot > slash + 1);
  return (has_extension ? log.substr(0, dot) : log) + ".truth.json";
}

// The log, and the truth with what the run was made of.
void write(const std::string& path, rig::RigLog& log, const std::string& model, const std::string& model_sha256) {
  log.truth["version"] = SERVODX_VERSION;
  log.truth["schema"] = result_schema;
  log.truth["inputs"] = {{{"path", model}, {"sha256", model_sha256}}};
  write_log(path, log.columns, log.comments);
  log.truth["sha256"] = sha256_of_file(path);
  write_file(truth_path(path), log.truth.dump(2) + "\n");
}

int one_log(Options& options, Invocation& invocation, const rig::RigModel& model, const std::string& model_sha256,
            const std::optional<rig::PlayedCommand>& played) {
  const std::atomic<bool>& stop = stop_on_interrupt();
  Progress progress("rig", {.quiet = options.common.quiet});
  options.run.stop = &stop;
  options.run.progress = [&](double fraction) { progress.update(fraction, 0); };
  rig::RigLog log = played ? rig::run_rig(model, options.run, played->stimulus) : rig::run_rig(model, options.run);
  if (played) log.truth["played"] = {{"path", options.command}, {"sha256", played->sha256}};
  write(options.output, log, options.model, model_sha256);
  invocation.header().simulations = 1;
  const std::size_t samples = log.columns.front().value.size();
  const std::string truth = truth_path(options.output);
  if (invocation.wants_report())
    invocation.write_report(
        report::columns_page(invocation.header(), "Log of the virtual rig: " + options.run.excitation, log.columns));
  invocation.finish(fmt::format("wrote {} ({} samples) and {}\n", options.output, samples, truth),
                    {{"output", options.output}, {"truth_file", truth}, {"samples", samples}, {"truth", log.truth}});
  return stop ? interrupted : ran;
}

// A file's length and rate hold unless the call gives its own.
std::optional<rig::PlayedCommand> command_to_play(Options& options, const rig::RigModel& model,
                                                  report::Header& header) {
  if (options.command.empty()) return {};
  constexpr double amperes_a_metre = 1.0;  // mA/mm
  std::optional<double> gain;
  if (options.loop_gain) gain = *options.loop_gain * amperes_a_metre;
  rig::PlayedCommand played = rig::played_command(options.command, model, gain);
  options.run.excitation = options.loop_gain ? "setpoint" : "command";
  if (!options.duration) options.run.duration = played.duration;
  if (!options.rate) options.run.rate = played.rate;
  header.inputs.push_back({options.command, played.sha256});
  return played;
}

int labelled_set(const Options& options, Invocation& invocation, const rig::RigModel& model,
                 const std::string& model_sha256) {
  const std::vector<rig::FleetLog> plan = rig::plan_fleet(options.fleet);
  const fs::path root = options.folder;
  std::set<std::string> folders;
  for (const auto& log : plan) {
    fs::create_directories((root / log.folder / log.path).parent_path());
    folders.insert(log.folder);
  }
  const std::atomic<bool>& stop = stop_on_interrupt();
  Progress progress("rig", {.quiet = options.common.quiet});
  const auto written = rig::run_fleet(
      model, plan, options.common.threads, stop,
      [&](const rig::FleetLog& item, const rig::RigModel&, rig::RigLog&& log) {
        write((root / item.folder / item.path).string(), log, options.model, model_sha256);
      },
      [&](double fraction, long logs) { progress.update(fraction, logs); });
  for (const auto& folder : folders) {
    write_file((root / folder / "rig.toml").string(), rig::data_sheet(model));
    write_file((root / folder / "truth.csv").string(), rig::truth_table(plan, written, folder));
  }
  const auto n = std::count(written.begin(), written.end(), true);
  invocation.header().simulations = n;
  invocation.finish(
      fmt::format("wrote {} of {} logs of {} valves to {}; truth.csv and rig.toml in each valve's folder\n", n,
                  plan.size(), folders.size(), options.folder),
      {{"output", options.folder}, {"logs", n}, {"valves", folders}});
  return stop ? interrupted : ran;
}

// The table of valve facts, and the torque motor's map.
int facts_of(const Options& options, Invocation& invocation, const rig::RigModel& model) {
  const std::string limits_path = (fs::path(options.model).parent_path() / "valve_facts.csv").string();
  const auto limits = rig::read_fact_limits(limits_path, model.name);
  report::Columns table("lrlrrl");
  table.row({"fact", "measured", "unit", "real", "valves", "range from"});
  report::Json items = report::Json::array();
  for (const auto& fact : rig::measure_facts(model)) {
    const auto limit =
        std::find_if(limits.begin(), limits.end(), [&](const auto& known) { return known.name == fact.name; });
    report::Json item{{"name", fact.name}, {"unit", fact.unit}, {"value", fact.value}};
    std::string low, high, source;
    if (limit != limits.end()) {
      const bool within = fact.value >= limit->low && fact.value <= limit->high;
      item.update({{"low", limit->low}, {"high", limit->high}, {"within", within}, {"source", limit->source}});
      low = fmt::format("{:.4g} to", limit->low);
      high = fmt::format("{:.4g}", limit->high);
      source = within ? limit->source : "OUTSIDE: " + limit->source;
    }
    table.row({fact.name, fmt::format("{:.4g}", fact.value), fact.unit, low, high, source});
    items.push_back(item);
  }
  invocation.finish(table.text(), {{"facts", items}});
  return ran;
}

int torque_map(const Options& options, Invocation& invocation, const rig::RigModel& model) {
  std::string text = "current [mA],angle [mrad],torque [mN m]\n";
  for (const rig::TorquePoint& point : rig::torque_map(model)) {
    text += fmt::format("{:.6g},{:.6g},{:.6g}\n", 1e3 * point.current, 1e3 * point.angle, 1e3 * point.torque);
  }
  write_file(options.torque, text);
  invocation.finish(fmt::format("wrote {}\n", options.torque), {{"output", options.torque}});
  return ran;
}

void check_played(const Options& options) {
  require_option(!options.loop_gain || !options.command.empty(), "--loop-gain", "is for a file with a setpoint",
                 "name it with --command FILE");
  require_option(!options.loop_gain || *options.loop_gain > 0, "--loop-gain", "must lie above nought",
                 "give it in mA/mm");
  if (options.command.empty()) return;
  require_option(!options.excitation, "--command", "drives the rig, and so does --excitation", "give one of them");
  require_option(options.fleet.logs == 0 && !options.facts && options.torque.empty(), "--command",
                 "makes one log of one valve", "leave out --fleet, --facts and --torque-map");
  require_option(options.run.amplitude == 0 && options.run.frequency == 0, "--command", "is played as it is",
                 "leave out --amplitude and --frequency");
}

void check_call(const Options& options) {
  check_played(options);
  if (options.facts || !options.torque.empty()) {
    require_option(options.output.empty() && options.fleet.logs == 0, options.facts ? "--facts" : "--torque-map",
                   "writes no log", "leave out --output and --fleet");
    return;
  }
  if (options.fleet.logs == 0) {
    require_option(!options.output.empty(), "--output", "is missing", "name the log with -o LOG.csv");
    require_option(options.folder.empty(), "--out", "is for a fleet", "add --fleet N, or name the log with -o LOG.csv");
    return;
  }
  require_option(options.output.empty(), "--output", "names one log", "name a fleet's folder with --out DIR");
  require_option(!options.folder.empty(), "--out", "is missing", "name the folder of the fleet");
  require_option(options.faults.empty() && options.valve == 0, "--fleet", "has its own faults and valves",
                 "leave out --fault and --valve");
  require_option(!fs::exists(options.folder) || (fs::is_directory(options.folder) && fs::is_empty(options.folder)),
                 "--out", "'" + options.folder + "' is there and not empty", "name a new folder");
}

int run(Options& options) {
  check_call(options);
  options.model = shipped_path(options.model);
  options.run.seed = options.fleet.seed = options.common.seed;
  options.run.temperature = options.celsius.value_or(40.0) + zero_celsius;
  if (options.celsius) options.fleet.temperature = options.run.temperature;
  if (options.duration) options.run.duration = options.fleet.duration = *options.duration;
  if (options.rate) options.run.rate = *options.rate;
  options.fleet.rate = options.run.rate;
  options.fleet.excitation = options.excitation;
  options.run.excitation = options.excitation.value_or(options.run.excitation);
  options.run.faults.clear();
  for (const auto& fault : options.faults) rig::add_fault(fault, options.run.faults);
  Invocation invocation("rig", options.common);
  const bool fleet = options.fleet.logs != 0;
  std::vector<std::string> outputs;
  if (!options.torque.empty()) outputs = {options.torque};
  if (!options.output.empty()) outputs = {options.output, truth_path(options.output)};
  std::vector<std::string> inputs = {options.model};
  if (!options.command.empty()) inputs.push_back(options.command);
  invocation.check_files(inputs, outputs);
  rig::RigModel model = rig::another_valve(rig::read_rig_model(options.model), options.valve);
  for (const auto& change : options.changes) rig::set_value(model, change);
  const std::string model_sha256 = sha256_of_file(options.model);

  report::Header& header = invocation.header();
  header.inputs.push_back({options.model, model_sha256});
  const std::optional<rig::PlayedCommand> played = command_to_play(options, model, header);
  *header.settings = {{"excitation", options.run.excitation},
                      {"duration", fleet ? options.fleet.duration : options.run.duration},
                      {"rate", options.run.rate},
                      {"temperature", options.celsius.value_or(40.0)},
                      {"faults", options.faults},
                      {"changed", options.changes},
                      {"valve", options.valve}};
  if (played) (*header.settings)["command"] = options.command;
  if (options.loop_gain) (*header.settings)["loop_gain"] = *options.loop_gain;
  if (fleet) (*header.settings)["fleet"] = options.fleet.logs;
  if (invocation.dry_run()) return ran;
  if (options.facts) return facts_of(options, invocation, model);
  if (!options.torque.empty()) return torque_map(options, invocation, model);
  return fleet ? labelled_set(options, invocation, model, model_sha256)
               : one_log(options, invocation, model, model_sha256, played);
}

std::string names() {
  std::string text = "Excitations:\n";
  for (const auto& e : rig::excitations()) text += "  " + e.name + ": " + e.description + "\n";
  text += "Faults (severity: mild, medium, severe or a value):\n";
  for (const auto& f : rig::rig_faults()) text += "  " + rig::word_of(f) + ": " + f.description + "\n";
  return text;
}

}  // namespace

void add_rig_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("rig", "The virtual rig writes a log and LOG.truth.json");
  command->add_option("--rig-model", options->model, "the rig's definition, params/rigs/*.toml")->capture_default_str();
  command->add_option("--excitation", options->excitation, "what drives it; names below; without: mixed");
  command->add_option("--command", options->command, "play this command ('servodx plan' writes such), CSV")
      ->type_name("FILE");
  command->add_option("--loop-gain", options->loop_gain,
                      "play the file's setpoint in a proportional position loop of this gain [mA/mm]");
  command->add_option("--duration", options->duration, "length of a log [s]; without: 5, of a fleet 4");
  command->add_option("--rate", options->rate, "samples and control ticks a second [Hz]; without: 1000");
  command->add_option("--temperature", options->celsius, "oil and valve [degC]; without: 40, of a fleet -20 to 65");
  command->add_option("--air", options->run.air, "free air in the oil, volume fraction")->capture_default_str();
  command->add_option("--viscosity", options->run.viscosity, "of the oil, over what the rig's definition says of it")
      ->capture_default_str();
  command->add_option("--amplitude", options->run.amplitude, "fraction of rated current; 0: the excitation's own");
  command->add_option("--frequency", options->run.frequency, "of sine, triangle, preflight [Hz]; 0: its own");
  command->add_option("--fault", options->faults,
                      "NAME=SEVERITY, NAME=SEVERITY@START [s] to step in, @START..END to grow; may be repeated");
  command->add_flag("--offset", options->run.offset,
                    "add the null offset of flight, Borello 2009: constant, steps, ramps");
  command->add_option("--valve", options->valve, "another valve of the type, drawn from its tolerances; 0: as defined")
      ->capture_default_str();
  command->add_option(
      "--set", options->changes,
      "GROUP.NAME=VALUE in SI, sensors.SIGNAL.KEY=VALUE, or ports|first_stage|coil_wiring=WORD; may be repeated");
  command->add_option("--onset", options->run.onset,
                      "start of faults that name none [s]; without: from the log's start");
  command->add_option("--jitter", options->run.jitter, "rms of the sampling instants [s]");
  command->add_option("--channels", options->run.channels, "signals to log beside time and command")->delimiter(',');
  command->add_option("-o,--output", options->output, "the log, CSV; the truth goes beside it")->type_name("LOG.csv");
  command->add_flag("--facts", options->facts, "measure what a test stand would, beside the range of real valves");
  command->add_option("--torque-map", options->torque, "write the torque motor's torque against current and angle")
      ->type_name("MAP.csv");
  command->add_option("--fleet", options->fleet.logs, "write a labelled set of N logs to --out DIR")->type_name("N");
  command->add_option("--valves", options->fleet.valves, "of the fleet; without: one for every 30 logs")
      ->type_name("M");
  command->add_option("--out", options->folder, "new folder of the fleet")->type_name("DIR");
  add_common_options(*command, options->common, RigOption::left_out);
  command->footer(names());
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace servodx
