// `servodx join FIRST SECOND`: two recorders of one test on one clock.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "invocation.h"
#include "servodx/join.h"
#include "servodx/log.h"
#include "servodx/rig.h"

namespace servodx {
namespace {

struct Options {
  CommonOptions common;
  std::string first, second, output, by;
  double near = 0;
  bool near_given = false;
};

void run(const Options& options) {
  JoinOptions join;
  if (!options.by.empty()) {
    join.by = find_signal(options.by);
    require_option(join.by.has_value(), "--by", "unknown signal '" + options.by + "'", "see 'servodx list signals'");
  }
  if (options.near_given) join.near = options.near;
  join.validate();
  Invocation invocation("join", options.common);
  invocation.check_files({options.first, options.second}, {options.output});
  const RigFile rig = invocation.rig();
  constexpr ReadOptions part_of_a_log{.require_response = false, .require_drive = false};
  const Log first = invocation.log(options.first, rig, part_of_a_log);
  const Log second = invocation.log(options.second, rig, part_of_a_log);
  if (invocation.dry_run()) return;
  ClockFit clock;
  const Log joined = join_recorders(first, second, join, clock);

  const std::string settled = fmt::format(
      "{} on the clock of {} by '{}': offset {:.6f} s (+- {:.1e}), skew {:.2f} ppm (+- {:.2g})", options.second,
      options.first, name_of(clock.by), clock.offset, clock.offset_error, 1e6 * clock.skew, 1e6 * clock.skew_error);
  write_log(options.output, columns_of(joined), {settled});

  invocation.note(joined.notes);
  if (std::isnan(clock.offset_error))
    invocation.note({fmt::format("too short to state an error of the clock: {} pieces", clock.pieces)});
  invocation.finish(fmt::format("{}\ncorrelation {:.5f}; {} samples: {}\n", settled, clock.correlation,
                                joined.samples(), options.output),
                    {{"output", options.output},
                     {"samples", joined.samples()},
                     {"clock",
                      {{"signal", name_of(clock.by)},
                       {"offset", {{"value", clock.offset}, {"std_error", clock.offset_error}, {"unit", "s"}}},
                       {"skew", {{"value", clock.skew}, {"std_error", clock.skew_error}, {"unit", "-"}}},
                       {"correlation", clock.correlation}}}});
}

}  // namespace

void add_join_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("join", "Two recorders of one test, each with its own clock, as one log");
  command->add_option("FIRST", options->first, "log whose clock stands; best the one with the command")->required();
  command->add_option("SECOND", options->second, "log with further signals and one that both recorded")->required();
  command->add_option("-o,--output", options->output, "the joined log")->required()->type_name("LOG.csv");
  command->add_option("--by", options->by, "the shared signal that settles the clock; else the one that does it best")
      ->type_name("SIGNAL");
  CLI::Option* near =
      command->add_option("--near", options->near, "offset, roughly, where the signals repeat [s]")->type_name("S");
  add_common_options(*command, options->common);
  command->callback([options, near] {
    options->near_given = near->count() > 0;
    run(*options);
  });
}

}  // namespace servodx
