// `servodx history show|event|export|import|verify`: the store behind `check` and `trend`.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/error.h"
#include "commands.h"
#include "invocation.h"
#include "report/shared/columns.h"
#include "report/shared/json.h"
#include "servodx/history.h"
#include "servodx/trend.h"

namespace servodx {
namespace {

struct Options {
  CommonOptions common;
  std::string history, file, valve, kind, text;
  double at = 0;
};

void show(const Options& options) {
  Invocation invocation("history show", options.common);
  invocation.check_files({options.history}, {});
  const History history = History::open(options.history);
  if (invocation.dry_run()) return;
  report::Columns rows("llrrr");
  rows.row({"valve", "serial", "checks", "hours", "events"});
  report::Json valves = report::Json::array();
  for (const std::string& name : history.valves()) {
    const HeldValve v = held_valve(history, name);
    rows.row(
        {v.valve, v.serial, std::to_string(v.checks), fmt::format("{}", v.last_at), std::to_string(v.events.size())});
    report::Json events = report::Json::array();
    for (const RecordedEvent& e : v.events)
      events.push_back({{"at", e.at}, {"kind", name_of(e.kind)}, {"text", e.text}});
    valves.push_back({{"valve", v.valve},
                      {"serial", v.serial},
                      {"checks", v.checks},
                      {"last_at", v.last_at},
                      {"unit", "h"},
                      {"events", events}});
  }
  invocation.finish(rows.text(), {{"schema", History::schema()}, {"valves", valves}});
}

void add_event(const Options& options) {
  require_event(options.at, options.kind);
  Invocation invocation("history event", options.common);
  invocation.check_files({options.history}, {});
  History history = History::open(options.history);
  held_valve(history, options.valve);  // refuses a name that is only mistyped
  *invocation.header().settings = {{"valve", options.valve}, {"at", options.at}, {"kind", options.kind}};
  if (invocation.dry_run()) return;
  history.add_event(options.valve, options.at, options.kind, options.text);
  invocation.finish(fmt::format("{} at {} h: {}\n", options.valve, options.at, options.kind),
                    {{"valve", options.valve}, {"at", options.at}, {"kind", options.kind}});
}

void write_csv(const Options& options) {
  Invocation invocation("history export", options.common);
  invocation.check_files({options.history}, {options.file});
  const History history = History::open(options.history);
  if (invocation.dry_run()) return;
  const Exported out = export_history(history, options.file);
  invocation.finish(fmt::format("{} valves and {} tuned tables: {}\n", out.valves, out.tables, options.file),
                    {{"output", options.file}, {"valves", out.valves}});
}

void read_csv(const Options& options) {
  Invocation invocation("history import", options.common);
  invocation.check_files({options.file}, {options.history});
  if (options.common.dry_run) rehearse_import(options.history, options.file);
  if (invocation.dry_run()) return;
  const Imported count = import_history(options.history, options.file);
  if (count.present > 0)
    invocation.note({fmt::format("{} rows were in the history already and are left as they are", count.present)});
  invocation.finish(fmt::format("{} checks and {} events added\n", count.checks, count.events),
                    {{"checks", count.checks}, {"events", count.events}, {"present", count.present}});
}

// Files of a folder that may be exports, by name; one that is being written has another ending.
std::vector<std::string> exports_in(const std::string& folder) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.is_regular_file() && entry.path().extension() == ".csv") files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  if (files.empty())
    throw InputError({.file = folder}, "holds no CSV", "name the folder that 'servodx history export' wrote into");
  return files;
}

// Each file whole or not at all. A node that exports again writes all that it has: what is there is passed over, so a
// folder may be imported as often as one likes.
int read_folder(const Options& options) {
  Invocation invocation("history import", options.common);
  invocation.check_files({}, {options.history});
  if (History::there(options.history)) History::open(options.history);  // refused before the first file
  Imported all;
  report::Json set_aside = report::Json::array();
  const std::vector<std::string> files = exports_in(options.file);
  for (const std::string& file : files) try {
      if (options.common.dry_run) {
        rehearse_import(options.history, file);
        continue;
      }
      const Imported count = import_history(options.history, file);
      all.checks += count.checks, all.events += count.events, all.present += count.present;
    } catch (const InputError& error) {
      std::fprintf(stderr, "history import: set aside: %s\n", (file + ": " + error.what()).c_str());
      set_aside.push_back({{"file", file}, {"rule", error.rule}, {"mend", error.mend}});
    }
  *invocation.header().settings = {{"folder", options.file}, {"files", files.size()}, {"set_aside", set_aside.size()}};
  const int code = set_aside.empty() ? ran : some_set_aside;
  if (invocation.dry_run()) return code;
  if (all.present > 0)
    invocation.note({fmt::format("{} rows were in the history already and are left as they are", all.present)});
  invocation.finish(fmt::format("{} checks and {} events added from {} files, {} set aside\n", all.checks, all.events,
                                files.size() - set_aside.size(), set_aside.size()),
                    {{"checks", all.checks},
                     {"events", all.events},
                     {"present", all.present},
                     {"files", files.size()},
                     {"set_aside", set_aside}});
  return code;
}

void verify(const Options& options, int& exit_code) {
  Invocation invocation("history verify", options.common);
  invocation.check_files({options.history}, {});
  const History history = History::open(options.history);
  if (invocation.dry_run()) return;
  const std::string found = history.verify();
  if (found != "ok") exit_code = failed_inside;
  invocation.finish(options.history + ": " + found + "\n", {{"found", found}});
}

}  // namespace

void add_history_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("history", "What a history holds; maintenance events; CSV out and in");
  command->require_subcommand(1);
  const auto part = [&](const char* name, const char* meaning) {
    CLI::App* sub = command->add_subcommand(name, meaning);
    sub->add_option("--history", options->history, "history file")->required()->type_name("H.db");
    add_common_options(*sub, options->common);
    return sub;
  };
  part("show", "The valves, their hours and events")->callback([options] { show(*options); });
  CLI::App* event = part("event", "Records maintenance; it restarts the trends that it renews");
  event->add_option("KIND", options->kind, event_names())->required();
  event->add_option("--valve", options->valve, "name of the valve")->required()->type_name("ID");
  event->add_option("--at", options->at, "hours of use")->required()->type_name("HOURS");
  event->add_option("--text", options->text, "what was done")->type_name("TEXT");
  event->callback([options] { add_event(*options); });
  CLI::App* out = part("export", "Everything as CSV");
  out->add_option("-o,--output", options->file, "CSV")->required()->type_name("FILE");
  out->callback([options] { write_csv(*options); });
  CLI::App* in = part("import", "Adds what a CSV holds and the history does not; all of it or nothing");
  in->add_option("FILE", options->file, "CSV of an export, or a folder of them: each whole or not at all")->required();
  in->callback([options, &exit_code] {
    if (std::filesystem::is_directory(options->file))
      exit_code = read_folder(*options);
    else
      read_csv(*options);
  });
  part("verify", "Looks for damage")->callback([options, &exit_code] { verify(*options, exit_code); });
}

}  // namespace servodx
