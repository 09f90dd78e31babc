// The library in your own program: tune on fault-free logs, set a threshold by others, judge one.
//   diagnose_log RIG.toml PARAMS.csv SUSPECT.csv FAULT_FREE.csv...     the first half tunes, the rest is the baseline
#include <cstdio>

#include "servodx/servodx.h"

int main(int argc, char** argv) {
  if (argc < 9) return std::fprintf(stderr, "diagnose_log RIG PARAMS SUSPECT and at least five fault-free logs\n"), 2;
  using namespace servodx;
  try {
    const Rig rig = read_rig_file(argv[1]);
    std::vector<Log> tuning, others;
    for (int i = 4; i < argc; ++i) (i < 4 + (argc - 4) / 2 ? tuning : others).push_back(read_log(argv[i], rig));
    // A rehearsal: a table that is to be relied on takes the default generations.
    const Tuned tuned = tune(tuning, read_table(argv[2]), rig, {.generations = 1, .rounds = 2});
    const Baseline baseline = make_baseline(others, tuned, rig, {.false_alarm = 0.25});
    const Verdict verdict = diagnose(read_log(argv[3], rig), tuned, rig, baseline);
    std::printf("%s: %s %s\n", argv[3], name_of(verdict.kind).c_str(), verdict.fault.c_str());
    if (verdict.severity)
      std::printf("severity %.3g (%.3g to %.3g) %s\n", verdict.severity->value, verdict.severity->lower,
                  verdict.severity->upper, verdict.severity->unit.c_str());
    for (const auto& [label, p] : verdict.probabilities) std::printf("  %-24s %.3f\n", label.c_str(), p);
    return 0;
  } catch (const InputError& error) {  // file, line, column, what is wrong and how to mend it
    return std::fprintf(stderr, "%s\n", error.what()), 2;
  }
}
