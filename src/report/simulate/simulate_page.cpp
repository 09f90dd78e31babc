#include "report/simulate/simulate_page.h"

#include "report/shared/parts.h"
#include "report/shared/replay_part.h"
#include "servodx/replay.h"

namespace servodx::report {

Page simulate_page(const Header& header, const Replay& replay) {
  Page page(header, "Simulation of " + file_name(replay.log));
  Verdict v;
  v.headline = "The model, driven by the inputs of " + file_name(replay.log);
  page.verdict(v);
  page.section("Measured and simulated", "Nothing is fitted: the table's values as they stand.");
  add_replay(page, replay, {.shown = {}, .onset = {}, .logs = 1});
  return page;
}

}  // namespace servodx::report
