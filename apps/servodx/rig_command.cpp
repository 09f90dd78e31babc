#include "rig_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "base/atomic_file.h"
#include "base/sha256.h"
#include "invocation.h"
#include "rig/rig_run.h"
#include "signals/log.h"

namespace servodx {
namespace {

struct Options {
  CommonOptions common;
  std::string model = "params/rigs/borello2009.toml";
  std::string output;
  double celsius = 40.0;
  std::vector<std::string> faults, changes;
  std::uint64_t valve = 0;
  rig::RigRun run;
};

// LOG.csv -> LOG.truth.json
std::string truth_path(const std::string& log) {
  const auto dot = log.rfind('.');
  const auto slash = log.find_last_of('/');
  const bool has_extension = dot != std::string::npos && (slash == std::string::npos || dot > slash + 1);
  return (has_extension ? log.substr(0, dot) : log) + ".truth.json";
}

void run(Options& options) {
  require_option(options.common.rig.empty(), "--rig", "is a data sheet, and the virtual rig is not made from one",
                 "name the rig's definition with --rig-model");
  options.run.seed = options.common.seed;
  options.run.temperature = options.celsius + rig::zero_celsius;
  options.run.faults.clear();
  for (const auto& fault : options.faults) rig::add_fault(fault, options.run.faults);
  Invocation invocation("rig", options.common);
  const std::string truth = truth_path(options.output);
  invocation.check_files({options.model}, {options.output, truth});
  rig::RigModel model = rig::another_valve(rig::read_rig_model(options.model), options.valve);
  for (const auto& change : options.changes) rig::set_value(model, change);
  const std::string model_sha256 = sha256_of_file(options.model);

  rig::RigLog log = rig::run_rig(model, options.run);
  log.truth["version"] = SERVODX_VERSION;
  log.truth["inputs"] = {{{"path", options.model}, {"sha256", model_sha256}}};
  write_log(options.output, log.columns, log.comments);
  log.truth["sha256"] = sha256_of_file(options.output);
  write_file(truth, log.truth.dump(2) + "\n");

  report::Header& header = invocation.header();
  header.inputs.push_back({options.model, model_sha256});
  header.simulations = 1;
  header.settings = {{"excitation", options.run.excitation},
                     {"duration", options.run.duration},
                     {"rate", options.run.rate},
                     {"temperature", options.celsius},
                     {"faults", options.faults}};
  const std::size_t samples = log.columns.front().value.size();
  invocation.finish(fmt::format("wrote {} ({} samples) and {}\n", options.output, samples, truth),
                    {{"output", options.output}, {"truth_file", truth}, {"samples", samples}, {"truth", log.truth}});
}

std::string names() {
  std::string text = "Excitations:\n";
  for (const auto& e : rig::excitations()) text += "  " + e.name + ": " + e.description + "\n";
  text += "Faults (severity: mild, medium, severe or a value):\n";
  for (const auto& f : rig::rig_faults()) text += "  " + f.name + ": " + f.description + "\n";
  return text;
}

}  // namespace

void add_rig_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("rig", "The virtual rig writes a log and LOG.truth.json");
  command->add_option("--rig-model", options->model, "the rig's definition, params/rigs/*.toml")->capture_default_str();
  command->add_option("--excitation", options->run.excitation, "what drives it; names below")->capture_default_str();
  command->add_option("--duration", options->run.duration, "length of the log [s]")->capture_default_str();
  command->add_option("--rate", options->run.rate, "samples and control ticks a second [Hz]")->capture_default_str();
  command->add_option("--temperature", options->celsius, "oil and valve [degC]")->capture_default_str();
  command->add_option("--air", options->run.air, "free air in the oil, volume fraction")->capture_default_str();
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
  command->add_option("-o,--output", options->output, "the log, CSV; the truth goes beside it")
      ->required()
      ->type_name("LOG.csv");
  add_common_options(*command, options->common);
  command->footer(names());
  command->callback([options] { run(*options); });
}

}  // namespace servodx
