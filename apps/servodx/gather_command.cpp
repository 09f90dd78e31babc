// `servodx gather DIR`: the results of many logs as one table, and, with the truth, what they are worth.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>

#include "base/atomic_file.h"
#include "commands.h"
#include "invocation.h"
#include "report/fleet/fleet.h"
#include "report/shared/json.h"
#include "servodx/fleet.h"

namespace servodx {
namespace {

struct Options {
  CommonOptions common;
  std::string folder, truth, output;
};

void note_counts(Invocation& invocation, const FleetCounts& counts) {
  if (counts.without_truth > 0)
    invocation.note({std::to_string(counts.without_truth) + " results have no truth and are not in its counts"});
  if (counts.without_result > 0)
    invocation.note({std::to_string(counts.without_result) + " rows of the truth have no result"});
}

// The folder from where the page stands; empty: the page is on paper alone.
std::string seen_from(const std::string& page, const std::string& folder) {
  if (page.empty()) return "";
  namespace fs = std::filesystem;
  std::error_code ignored;
  return fs::proximate(folder, fs::absolute(page).parent_path(), ignored).generic_string();
}

int run(const Options& options) {
  Invocation invocation("gather", options.common);
  std::vector<std::string> inputs, outputs;
  if (!options.truth.empty()) inputs.push_back(options.truth);
  if (!options.output.empty()) outputs.push_back(options.output);
  invocation.check_files(inputs, outputs);
  std::optional<FleetTruth> truth;
  if (!options.truth.empty()) truth = read_truth(options.truth);
  report::Header& header = invocation.header();
  if (truth) header.inputs.push_back({truth->path, truth->sha256});
  *header.settings = {{"folder", options.folder}};
  const Fleet fleet = gather_results(options.folder, invocation.watch());
  std::optional<FleetCounts> found;
  if (truth) found = count_fleet(fleet, *truth, options.common.seed);
  if (invocation.dry_run()) return ran;
  if (fleet.interrupted) return interrupted;  // a part of the folder is no table of it
  if (found) note_counts(invocation, *found);
  if (fleet.without_schema > 0)
    invocation.note({std::to_string(fleet.without_schema) +
                     " results carry no schema, as earlier versions wrote them; they are read as far as they go"});
  if (!options.output.empty()) write_file(options.output, fleet.csv);
  const FleetCounts* counts = found ? &*found : nullptr;
  if (invocation.wants_report())
    invocation.write_report(
        report::fleet_page(header, fleet, counts, seen_from(options.common.report, options.folder)));
  invocation.finish(report::text_of(fleet, counts), report::fleet_json(fleet, counts));
  return fleet.unread.empty() ? ran : some_set_aside;
}

}  // namespace

void add_gather_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("gather", "A folder of results as one table and page, worst first");
  command->add_option("DIR", options->folder, "folder that 'diagnose --list' wrote")->required();
  command->add_option("-o,--output", options->output, "the table as CSV, SI units")->type_name("FILE.csv");
  command
      ->add_option("--truth", options->truth,
                   "CSV with the header log,class or log,class,severity: count what was found, named and falsely "
                   "accused")
      ->type_name("FILE.csv");
  add_common_options(*command, options->common);
  command->footer("Files that are no results are named and left out; the exit code is then 3.");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace servodx
