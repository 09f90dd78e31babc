// A whole diagnosis by the clock: every hypothesis on 10 s of the virtual rig whose spool sticks, as `diagnose` runs
// it.
#include "diagnose/diagnose.h"

#include <fmt/format.h>

#include <filesystem>

#include "diagnose/assessment.h"
#include "parameters/table.h"
#include "ratios/measure.h"
#include "ratios/rows.h"
#include "report/diagnosis_words.h"
#include "rig/rig_faults.h"
#include "rig/rig_model.h"
#include "rig/rig_run.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/tune.h"
#include "tune/tune.h"

namespace servodx::bench {

void diagnose_rows(Report& report, const Choice& choice) {
  const std::string folder = std::string(SERVODX_SOURCE_DIR) + "/";
  const RigFile rig = read_rig_file(folder + "data/rig.toml");
  std::vector<Log> healthy;
  for (const char* name : {"h01_steps_large", "h05_prbs", "h10_flight"})
    healthy.push_back(read_log(folder + "data/healthy/" + name + ".csv", rig));
  TuneOptions from_nominal;
  from_nominal.generations = 0;
  const Table tuned = tune_table(healthy, read_table(folder + "params/borello2009.csv"), rig, from_nominal).table;

  rig::RigRun run;
  run.duration = 10;
  run.seed = 301;
  rig::add_fault("sticky_spool=12", run.faults);
  const rig::RigLog made = rig::run_rig(rig::read_rig_model(folder + "params/rigs/borello2009.toml"), run);
  const std::string path = (std::filesystem::temp_directory_path() / "servodx_diagnose.csv").string();
  write_log(path, made.columns, made.comments);
  const Log log = read_log(path, rig);
  std::filesystem::remove(path);

  Assessment seen;
  const Timing t =
      take_turns({[&] { seen = assess(log, tuned, rig, {}); }}, std::min(3, choice.turns), wall_seconds).front();
  const auto likeliest =
      std::min_element(seen.hypotheses.begin(), seen.hypotheses.end(),
                       [](const HypothesisResult& a, const HypothesisResult& b) { return a.misfit < b.misfit; });
  report.add({"full diagnose of a 10 s log, all hypotheses, all cores", "60 s", "15 s",
              fmt::format("{:.1f} s", t.median),
              fmt::format("{:.1f} to {:.1f} s by the clock; {} simulations; finds {} {:.1f} for sticky_spool 12", t.low,
                          t.high, seen.simulations, servodx::report::label_of(likeliest->fault), likeliest->severity)});
  report.json["diagnose_seconds"] = t.median;
  report.json["diagnose"] = {{"lowest", t.low},
                             {"highest", t.high},
                             {"simulations", seen.simulations},
                             {"hypotheses", seen.hypotheses.size()},
                             {"likeliest", servodx::report::label_of(likeliest->fault)},
                             {"severity", likeliest->severity}};
}

}  // namespace servodx::bench
