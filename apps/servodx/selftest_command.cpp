// `servodx selftest LOG`: known truths on the user's own input; bias and coverage of the fit.
#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "invocation.h"
#include "report/selftest/selftest.h"
#include "report/shared/json.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/selftest.h"
#include "servodx/table.h"

namespace servodx {
namespace {

struct Options {
  CommonOptions common;
  std::string log, params;
  SelftestOptions selftest;
};

void run(const Options& options) {
  SelftestOptions how = options.selftest;
  how.validate();
  Invocation invocation("selftest", options.common);
  invocation.check_files({options.log, options.params}, {});
  const RigFile rig = invocation.rig();
  const Table table = invocation.table(options.params);
  const Log log = invocation.log(options.log, rig);
  report::Header& header = invocation.header();
  *header.settings = {{"repeats", how.repeats}, {"spread", how.spread}};
  if (invocation.dry_run()) return;
  how.seed = options.common.seed;
  how.threads = options.common.threads;
  how.watch = invocation.watch();
  const SelftestResult result = selftest(log, table, rig, how);
  header.simulations = result.simulations;
  header.failed_simulations = result.failed_simulations;
  if (invocation.wants_report()) invocation.write_report(report::selftest_page(header, result));
  invocation.finish(report::text_of(result), report::selftest_json(result));
}

}  // namespace

void add_selftest_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("selftest", "Recover known truths on a log's own input: bias and coverage of the fit");
  command->add_option("LOG", options->log, "the rig log whose input and noise are used, CSV")->required();
  command->add_option("--params", options->params, "parameter table about which truths are drawn")
      ->required()
      ->type_name("P");
  command->add_option("--repeats", options->selftest.repeats, "truths to recover")
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--spread", options->selftest.spread, "of the truths, as a part of each row's range")
      ->type_name("PART")
      ->capture_default_str();
  add_common_options(*command, options->common);
  command->callback([options] { run(*options); });
}

}  // namespace servodx
