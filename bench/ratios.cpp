// The ratio table: the kernel, the optimiser and the reader against the best that others offer, in one run.
//   servodx_bench_ratios [--json FILE] [--picture FILE.svg] [--only PART...] [--quick] [--seeds N] [--free N...]
//     [--peer-budget X]
//
// Ratios of things that took turns in this run; absolute times belong to this machine. Peers that were not installed
// when this was built are null in the JSON, with the reason. What it all means: docs/performance.md.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <map>

#include "base/atomic_file.h"
#include "base/keep_memory.h"
#include "ratios/measure.h"
#include "ratios/rows.h"
#include "report/shared/line_chart.h"
#include "servodx/instruction_set.h"
#include "simulate/simulate.h"

using namespace servodx;

namespace {

std::string machine() {
  std::ifstream info("/proc/cpuinfo");
  std::string model = "unknown processor";
  int cores = 0;
  for (std::string line; std::getline(info, line);) {
    if (line.starts_with("model name")) model = line.substr(line.find(':') + 2);
    cores += line.starts_with("processor");
  }
  std::ifstream load("/proc/loadavg");
  std::string busy;
  load >> busy;
  return fmt::format("{}, {} cores, {} ({} lanes), load average {} at the start; {}", model, cores, instruction_set(),
                     pack_width(), busy, __VERSION__);
}

}  // namespace

int main(int argc, char** argv) {
  keep_freed_memory();
  bench::Choice choice;
  std::string json_path, picture_path;
  bool quick = false;
  const std::vector<std::pair<std::string, void (*)(bench::Report&, const bench::Choice&)>> parts = {
      {"scaling", bench::scaling_rows},  // first: its processes inherit what this one holds
      {"kernel", bench::kernel_rows},   {"search", bench::search_rows},     {"genetic", bench::genetic_rows},
      {"loading", bench::loading_rows}, {"diagnose", bench::diagnose_rows}, {"functions", bench::function_rows},
      {"virtual", bench::virtual_rows}};  // last: more than half of the time
  std::vector<std::string> only;
  CLI::App app("the ratio table, measured");
  app.add_option("--json", json_path, "file for the figures");
  app.add_option("--picture", picture_path, "file for the plot of the scaling, SVG");
  app.add_option("--only", only, "parts: scaling, kernel, search, genetic, loading, diagnose, functions, virtual");
  app.add_flag("--quick", quick, "3 seeds, no peers, 3 turns: a look, not a measurement");
  app.add_option("--seeds", choice.seeds, "of the twin objectives")->capture_default_str();
  app.add_option("--free", choice.free, "parameters of the fits to a floor")
      ->check(CLI::IsMember({8, 15, 25}))
      ->capture_default_str();
  app.add_option("--peer-budget", choice.peer_budget, "simulations a peer may use, in medians of ours; 0: no peers")
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  if (quick) choice.seeds = 3, choice.peer_budget = 0, choice.floor_search = 5000, choice.turns = 3;

  bench::Report report;
  report.json["machine"] = machine();
  // Every key is there; what was not measured is null and says why.
  for (const char* key : {"scalar_vs_cvode2", "batch_vs_cvode2", "realtime_factor_per_core", "jacobian_in_simulations",
                          "failed_of_10000", "simulations_to_floor", "best_peer", "ga_plus_local_seconds_one_core",
                          "ga_two_thread_speedup", "load_vs_from_chars", "diagnose_seconds", "diagnose_fast_seconds",
                          "virtual_rig_simulations_to_floor", "virtual_rig_best_peer"})
    report.json[key] = nullptr;
  const double begun = bench::wall_seconds();
  const auto wanted = [&](const std::string& name) {
    return only.empty() || std::find(only.begin(), only.end(), name) != only.end();
  };
  for (const auto& part : parts)
    if (!wanted(part.first)) report.excuse("left_out", part.first);
  for (const auto& [name, run] : parts) {
    if (!wanted(name)) continue;
    fmt::print(stderr, "{}: at {:.0f} s\n", name, bench::wall_seconds() - begun);
    const double part = bench::wall_seconds();
    run(report, choice);
    report.json["seconds_of"][name] = bench::wall_seconds() - part;
    report.json["seconds"] = bench::wall_seconds() - begun;
    // After each part: what stops halfway leaves what it has measured.
    if (!json_path.empty()) write_file(json_path, report.json.dump(2) + "\n");
  }

  // Markdown, as it stands in docs/performance.md.
  fmt::print("{}\n\n| what | must | aim | measured | spread |\n| --- | --- | --- | --- | --- |\n",
             report.json["machine"].get<std::string>());
  for (const bench::Row& r : report.rows)
    fmt::print("| {} | {} | {} | {} | {} |\n", r.what, r.must, r.aim, r.measured, r.spread);
  fmt::print("\n");
  for (const std::string& note : report.notes) fmt::print("{}\n", note);
  if (report.json.contains("reasons")) fmt::print("not measured: {}\n", report.json["reasons"].dump());
  if (!picture_path.empty() && !report.panels.empty()) write_file(picture_path, report::svg_of(report.panels, 3));
  return 0;
}
