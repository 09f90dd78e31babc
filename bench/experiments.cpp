// The trials of the GA paper, repeated: its statements beside ours, with counts.
//
//   servodx_experiments DIR [--only STUDY,...] [--most N]
//
// DIR keeps a CSV a study, a line a trial; what is there is not run again, so a study may be run in pieces. Seeds are
// fixed. Type 1 of the paper, without rig data, is tune_up, selection and self_diagnosis (35 trials); type 2, with
// recorded data, is recorded (116 trials, the virtual rig in the rig's place).
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "experiments/studies.h"

using namespace servodx::experiments;

int main(int argc, char** argv) {
  const std::vector<std::pair<std::string, void (*)(Setup&)>> studies = {
      {"searches", searches},         {"tune_up", tune_up},
      {"selection", selection},       {"self_diagnosis", self_diagnosis},
      {"recorded", recorded},         {"populations", populations},
      {"rows_at_once", rows_at_once}, {"large_faults", large_faults}};
  std::vector<std::string> names;
  for (const auto& [name, run] : studies) names.push_back(name);
  CLI::App app("trials of the GA paper");
  std::string dir;
  std::vector<std::string> only = names;
  long most = 0;
  app.add_option("dir", dir, "folder of the records")->required();
  app.add_option("--only", only, "studies")->delimiter(',')->check(CLI::IsMember(names));
  app.add_option("--most", most, "trials that this run may add; 0: all");
  CLI11_PARSE(app, argc, argv);
  Setup setup = make_setup(dir);
  setup.most = most;
  for (const auto& [name, run] : studies) {
    if (std::find(only.begin(), only.end(), name) == only.end()) continue;
    fmt::print("\n== {}\n", name);
    run(setup);
  }
  return 0;
}
