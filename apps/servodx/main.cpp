// servodx: fault diagnosis of electrohydraulic servovalves from rig logs.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstring>
#include <exception>
#include <string>

#include "base/error.h"
#include "base/keep_memory.h"
#include "base/nearest.h"
#include "base/sleep_while_waiting.h"
#include "base/trouble.h"
#include "build.h"
#include "commands.h"
#include "invocation.h"
#include "report/list/trouble_words.h"
#include "rig_command.h"

namespace {

// "servodx tune: --params is required; 'servodx tune --help' lists the options"
std::string refusal(const CLI::App* app, const CLI::Error& error) {
  std::string call = app->get_name();
  for (const CLI::App* command : app->get_subcommands()) call += " " + command->get_name();
  if (const auto left = app->remaining(); app->get_subcommands().empty() && !left.empty()) {
    std::vector<std::string> commands;
    for (const CLI::App* command : app->get_subcommands({})) commands.push_back(command->get_name());
    return call + ": no command is called '" + left.front() + "'; " + servodx::did_you_mean(left.front(), commands) +
           "'" + call + " --help' lists what there is\n";
  }
  // A name misspelt is the reason why another is missing.
  for (const CLI::App* command : app->get_subcommands())
    for (const std::string& word : command->remaining())
      if (word.starts_with("--")) {
        std::vector<std::string> names;
        for (const CLI::Option* option : command->get_options())
          for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
        return call + ": no option is called '" + word + "'; " + servodx::did_you_mean(word, names) + "'" + call +
               " --help' lists what there is\n";
      }
  // "Could not convert: --at = abc"
  if (const std::string told = error.what(); dynamic_cast<const CLI::ConversionError*>(&error)) {
    const auto name = told.find(": "), equals = told.find(" = ");
    if (name != std::string::npos && equals != std::string::npos && name < equals)
      return call + ": " + told.substr(name + 2, equals - name - 2) + ": '" + told.substr(equals + 3) +
             "' is not a number; write one with a decimal point, like 12.5\n";
  }
  return call + ": " + error.what() + "; '" + call + " --help' lists what there is\n";
}

// Whether the call computes: one that only tells (--version, help, list) has no threads, and need not begin twice.
bool computes(int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return false;
  for (const char* tells : {"help", "completion", "man", "list"})
    if (std::strcmp(argv[1], tells) == 0) return false;
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace servodx;
  if (computes(argc, argv)) sleep_while_waiting(argv);
  keep_freed_memory();
  CLI::App app("Fault diagnosis of electrohydraulic servovalves from rig logs", "servodx");
  app.set_version_flag("--version", version_line, "version, commit of the sources, instruction set in use");
  app.require_subcommand(1);
  app.failure_message(refusal);
  int exit_code = ran;
  // In the order in which a rig's owner meets them.
  add_init_command(app);
  add_check_log_command(app);
  add_join_command(app);
  add_sensitivity_command(app, exit_code);
  add_tune_command(app, exit_code);
  add_baseline_command(app, exit_code);
  add_diagnose_command(app, exit_code);
  add_plan_command(app, exit_code);
  add_gather_command(app, exit_code);
  add_watch_command(app, exit_code);
  add_explain_command(app, exit_code);
  add_selftest_command(app);
  add_simulate_command(app);
  add_check_command(app, exit_code);
  add_trend_command(app);
  add_history_command(app, exit_code);
  add_monitor_command(app);
  add_curves_command(app);
  add_map_command(app);
  add_rig_command(app, exit_code);
  add_list_command(app);
  add_compare_command(app);
  add_rerun_command(app, exit_code);
  add_manual_commands(app);
  remember_call(argc, argv);
  try {
    app.parse(argc, argv);
    return as_ended(exit_code);
  } catch (const CLI::Error& call) {  // --help and --version come this way too
    return app.exit(call) == 0 ? ran : refused;
  } catch (const InputError& input) {
    std::fprintf(stderr, "servodx: %s\n", told(input).c_str());
    if (const auto trouble = trouble_of(input)) std::fprintf(stderr, "%s\n", report::where_to_read(*trouble).c_str());
    return refused;
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "servodx: failed inside: %s\n", failure.what());
    return failed_inside;
  }
}
