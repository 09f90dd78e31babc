// A whole diagnosis by the clock: every hypothesis on the virtual rig whose spool sticks, as `diagnose` runs it; 10 s
// at 1 kHz, and 50 s at 20 kHz, which is fitted at points (fit/fast_log.h).
#include "diagnose/diagnose.h"

#include <fmt/format.h>

#include <filesystem>

#include "diagnose/assessment.h"
#include "parameters/table.h"
#include "ratios/measure.h"
#include "ratios/rows.h"
#include "report/diagnose/verdict_words.h"
#include "rig/rig_faults.h"
#include "rig/rig_model.h"
#include "rig/rig_run.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/tune.h"
#include "tune/tune.h"

namespace servodx::bench {

namespace {

Table tuned_table(const RigFile& rig) {
  const std::string folder = std::string(SERVODX_SOURCE_DIR) + "/";
  std::vector<Log> healthy;
  for (const char* name : {"h01_steps_large", "h05_prbs", "h10_flight"})
    healthy.push_back(read_log(folder + "data/healthy/" + name + ".csv", rig));
  TuneOptions from_nominal;
  from_nominal.generations = 0;
  return tune_table(healthy, read_table(folder + "params/borello2009.csv"), rig, from_nominal).table;
}

Log log_of_stuck_spool(const RigFile& rig, double seconds, double rate) {
  rig::RigRun run;
  run.duration = seconds;
  run.rate = rate;
  run.seed = 301;
  rig::add_fault("sticky_spool=12", run.faults);
  const std::string model = std::string(SERVODX_SOURCE_DIR) + "/params/rigs/borello2009.toml";
  const rig::RigLog made = rig::run_rig(rig::read_rig_model(model), run);
  const std::string path = (std::filesystem::temp_directory_path() / "servodx_diagnose.csv").string();
  write_log(path, made.columns, made.comments);
  const Log log = read_log(path, rig);
  std::filesystem::remove(path);
  return log;
}

// What is asked, its must and its aim, and under which key it stands in the file.
struct Asked {
  std::string what, must, aim, key;
};

void add_row(Report& report, const Asked& asked, const Log& log, const Table& tuned, const RigFile& rig, int turns) {
  Assessment seen;
  const Timing t = take_turns({[&] { seen = assess(log, tuned, rig, {}); }}, turns, wall_seconds).front();
  const auto likeliest =
      std::min_element(seen.hypotheses.begin(), seen.hypotheses.end(),
                       [](const HypothesisResult& a, const HypothesisResult& b) { return a.misfit < b.misfit; });
  report.add({asked.what, asked.must, asked.aim, fmt::format("{:.1f} s", t.median),
              fmt::format("{:.1f} to {:.1f} s by the clock; {} simulations; finds {} {:.1f} for sticky_spool 12", t.low,
                          t.high, seen.simulations, servodx::report::label_of(likeliest->fault), likeliest->severity)});
  report.json[asked.key + "_seconds"] = t.median;
  report.json[asked.key] = {{"lowest", t.low},
                            {"highest", t.high},
                            {"simulations", seen.simulations},
                            {"hypotheses", seen.hypotheses.size()},
                            {"likeliest", servodx::report::label_of(likeliest->fault)},
                            {"severity", likeliest->severity}};
}

}  // namespace

void diagnose_rows(Report& report, const Choice& choice) {
  const RigFile rig = read_rig_file(std::string(SERVODX_SOURCE_DIR) + "/data/rig.toml");
  const Table tuned = tuned_table(rig);
  add_row(report, {"full diagnose of a 10 s log, all hypotheses, all cores", "60 s", "15 s", "diagnose"},
          log_of_stuck_spool(rig, 10, 1000), tuned, rig, std::min(3, choice.turns));
  add_row(report, {"the same of 1,000,000 rows, 50 s at 20 kHz", "60 s", "20 s", "diagnose_fast"},
          log_of_stuck_spool(rig, 50, 20'000), tuned, rig, 1);
}

}  // namespace servodx::bench
