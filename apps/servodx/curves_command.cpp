// `servodx curves LOG`: the standard figures of SAE ARP490 from a log, judged by the rig file's limits. With --params
// the dynamics that the rig file states, beside those of the table's valve.
#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/atomic_file.h"
#include "commands.h"
#include "invocation.h"
#include "report/curves/curves.h"
#include "report/curves/data_sheet.h"
#include "report/shared/conditions.h"
#include "report/shared/json.h"
#include "servodx/curves.h"
#include "servodx/data_sheet.h"
#include "servodx/error.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/table.h"

namespace servodx {
namespace {

struct Options {
  CommonOptions common;
  std::string log, params, svg, certificate;
};

// The sheet and the table alone.
void run_without_log(const Options& options) {
  Invocation invocation("curves", options.common);
  require_option(!options.params.empty(), "LOG", "neither a log nor a table is given",
                 "give a log, or --params P for the dynamics that the rig file states");
  invocation.check_files({options.params}, {});
  const RigFile rig = invocation.rig();
  const Table table = invocation.table(options.params);
  if (sheet_figures(rig).empty())
    throw InputError({.file = rig.path.empty() ? "--rig" : rig.path}, "states no dynamics of the valve",
                     "add step_rise_time, frequency_response or phase_lag_90_frequency under [valve], or name a log");
  if (invocation.dry_run()) return;
  const SheetFit stated = data_sheet(table, rig);
  if (invocation.wants_report()) invocation.write_report(report::data_sheet_page(invocation.header(), stated));
  report::Json json = report::curves_json({});
  json["data_sheet"] = report::data_sheet_json(stated);
  invocation.finish(report::text_of(stated), json);
}

void run(const Options& options) {
  if (options.log.empty()) return run_without_log(options);
  Invocation invocation("curves", options.common);
  std::vector<std::string> outputs;
  if (!options.svg.empty()) outputs.push_back(options.svg);
  std::vector<std::string> inputs = {options.log};
  if (!options.certificate.empty()) inputs.push_back(options.certificate);
  if (!options.params.empty()) inputs.push_back(options.params);
  invocation.check_files(inputs, outputs);
  const RigFile rig = invocation.rig();
  const Log log = invocation.log(options.log, rig);
  report::add_to_head(invocation.header().head, {log});
  const auto certificate = invocation.certificate(options.certificate);
  SheetOptions how;
  if (certificate) how = {certificate->errors(), certificate->guard};
  *invocation.header().settings = {{"guard_band", how.guard}};
  std::optional<Table> table;
  if (!options.params.empty()) table = invocation.table(options.params);
  if (invocation.dry_run()) return;
  std::optional<SheetFit> stated;
  if (table) stated = data_sheet(*table, rig);
  const AcceptanceSheet judged = acceptance_sheet(log, rig, how);
  const auto& sheet = *judged.whole;
  if (!options.svg.empty()) write_file(options.svg, report::curves_svg(sheet, *rig.fact("valve.rated_current")));
  invocation.note(judged.notes);
  if (invocation.wants_report())
    invocation.write_report(report::curves_page(
        invocation.header(), sheet, options.log, *rig.fact("valve.rated_current"), how.guard,
        {certificate ? &*certificate : nullptr, invocation.manifest()}, stated ? &*stated : nullptr));
  report::Json json = report::curves_json(sheet);
  std::string text = report::text_of(sheet, options.log, colour_wanted());
  if (stated) json["data_sheet"] = report::data_sheet_json(*stated), text += report::text_of(*stated);
  invocation.finish(text, json);
}

}  // namespace

void add_curves_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "curves", "Standard figures of a valve from a log: flow, pressure gain, leakage, hysteresis, Bode; pass or fail");
  command->add_option("LOG", options->log, "log of slow sweeps, or of a sine sweep; not needed with --params");
  command->add_option("--params", options->params, "table whose valve stands beside what the rig file states")
      ->type_name("P");
  command->add_option("--svg", options->svg, "picture of the curves")->type_name("FILE.svg");
  add_certificate_option(*command, options->certificate);
  add_common_options(*command, options->common);
  command->callback([options] { run(*options); });
}

}  // namespace servodx
