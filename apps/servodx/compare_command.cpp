// `servodx compare A.json B.json`: two results of one command beside each other.
#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/sha256.h"
#include "commands.h"
#include "invocation.h"
#include "report/compare/compare.h"
#include "store/result_json.h"

namespace servodx {
namespace {

struct Options {
  CommonOptions common;
  std::string a, b;
};

void run(const Options& options) {
  Invocation invocation("compare", options.common);
  invocation.check_files({options.a, options.b}, {});
  for (const std::string& path : {options.a, options.b})
    invocation.header().inputs.push_back({path, sha256_of_file(path)});
  if (invocation.dry_run()) return;
  const auto a = store::read_result(options.a), b = store::read_result(options.b);
  const report::Comparison comparison = report::compare(options.a, a, options.b, b);
  invocation.note(comparison.notes);
  if (invocation.wants_report()) invocation.write_report(report::compare_page(invocation.header(), comparison));
  invocation.finish(report::text_of(comparison), report::compare_json(comparison));
}

}  // namespace

void add_compare_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("compare", "Two results of one command beside each other: what changed, by how much");
  command->add_option("A", options->a, "a result, JSON")->required()->type_name("A.json");
  command->add_option("B", options->b, "another, JSON")->required()->type_name("B.json");
  add_common_options(*command, options->common);
  command->callback([options] { run(*options); });
}

}  // namespace servodx
