// The library in your own program: read a log and a table, simulate, print how far apart they are.
//   simulate_log LOG.csv PARAMS.csv [RIG.toml]
#include <cmath>
#include <cstdio>

#include "base/error.h"
#include "fit/log_data.h"
#include "fit/nominal.h"
#include "parameters/table.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "simulate/scenario.h"
#include "simulate/simulate.h"

int main(int argc, char** argv) {
  if (argc < 3) return std::fprintf(stderr, "simulate_log LOG.csv PARAMS.csv [RIG.toml]\n"), 2;
  using namespace servodx;
  try {
    const RigFile rig = argc > 3 ? read_rig_file(argv[3]) : RigFile{};
    const LogData log = prepare(read_log(argv[1], rig), rig);
    const Table table = apply_rig_facts(read_table(argv[2]), rig);
    const Trajectory simulated = simulate(log.scenario, candidate_of(table));
    for (const FitChannel& c : log.channels) {
      const std::vector<double>& y = simulated.signals[static_cast<std::size_t>(c.simulated)];
      if (y.empty()) continue;  // asked for by SimulateOptions::wanted
      double square = 0;
      for (std::size_t k = 0; k < y.size(); ++k) square += std::pow(c.measured[k] - y[k], 2);
      std::printf("%s: rms error %.3g %s\n", info(c.signal).name.data(),
                  std::sqrt(square / static_cast<double>(y.size())), info(c.signal).si_unit.data());
    }
    return simulated.ok ? 0 : 1;
  } catch (const InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
