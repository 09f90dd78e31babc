// The library in your own program: read a log and a table, simulate, print how far apart they are.
//   simulate_log LOG.csv PARAMS.csv [RIG.toml]
#include <cmath>
#include <cstdio>

#include "servodx/servodx.h"

int main(int argc, char** argv) {
  if (argc < 3) return std::fprintf(stderr, "simulate_log LOG.csv PARAMS.csv [RIG.toml]\n"), 2;
  using namespace servodx;
  try {
    const Rig rig = argc > 3 ? read_rig_file(argv[3]) : Rig{};
    const Log log = read_log(argv[1], rig);
    const Simulation simulation = simulate(log, read_table(argv[2]), rig);
    for (const OutputColumn& simulated : simulation.columns) {
      const std::vector<double>& measured = log[simulated.signal];
      double square = 0;
      std::size_t present = 0;
      for (std::size_t k = 0; k < measured.size(); ++k)
        if (std::isfinite(measured[k])) square += std::pow(measured[k] - simulated.value[k], 2), ++present;
      std::printf("%s: rms error %.3g in SI\n", name_of(simulated.signal).data(),
                  std::sqrt(square / static_cast<double>(present)));
    }
    return 0;
  } catch (const InputError& error) {
    return std::fprintf(stderr, "%s\n", error.what()), 2;
  }
}
