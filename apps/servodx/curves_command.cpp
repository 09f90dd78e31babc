// `servodx curves LOG`: the standard figures of SAE ARP490 from a log, judged by the rig file's limits.
#include <CLI/CLI.hpp>
#include <memory>

#include "base/atomic_file.h"
#include "commands.h"
#include "curves/curves.h"
#include "invocation.h"
#include "report/curves.h"
#include "servodx/log.h"
#include "servodx/rig.h"

namespace servodx {
namespace {

struct Options {
  CommonOptions common;
  std::string log, svg, certificate;
};

void run(const Options& options) {
  Invocation invocation("curves", options.common);
  std::vector<std::string> outputs;
  if (!options.svg.empty()) outputs.push_back(options.svg);
  std::vector<std::string> inputs = {options.log};
  if (!options.certificate.empty()) inputs.push_back(options.certificate);
  invocation.check_files(inputs, outputs);
  const RigFile rig = invocation.rig();
  const Log log = invocation.log(options.log, rig);
  const auto certificate = invocation.certificate(options.certificate);
  curves::SheetOptions how;
  if (certificate) how = {certificate->errors(), certificate->guard};
  invocation.header().settings = {{"guard_band", how.guard}};
  if (invocation.dry_run()) return;
  const curves::Sheet sheet = curves::read_curves(log, rig, how);
  if (!options.svg.empty()) write_file(options.svg, report::curves_svg(sheet, *rig.fact("valve.rated_current")));
  invocation.note(sheet.notes);
  if (invocation.wants_report())
    invocation.write_report(report::curves_page(invocation.header(), sheet, options.log,
                                                *rig.fact("valve.rated_current"), how.guard,
                                                {certificate ? &*certificate : nullptr, invocation.manifest()}));
  invocation.finish(report::text_of(sheet, options.log, colour_wanted()), report::curves_json(sheet));
}

}  // namespace

void add_curves_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "curves", "Standard figures of a valve from a log: flow, pressure gain, leakage, hysteresis, Bode; pass or fail");
  command->add_option("LOG", options->log, "log of slow sweeps, or of a sine sweep")->required();
  command->add_option("--svg", options->svg, "picture of the curves")->type_name("FILE.svg");
  add_certificate_option(*command, options->certificate);
  add_common_options(*command, options->common);
  command->callback([options] { run(*options); });
}

}  // namespace servodx
