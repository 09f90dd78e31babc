// Coverage of the 95 % intervals that `tune` states: twin experiments with 8, 15 and 25 free rows.
//   servodx_twins [SEEDS [THREADS]]
// Prints, row by row, in how many of the seeds the truth lay inside, and how many times the selection dropped the row;
// then all pooled.
//
// What this does not prove: the data come from the model itself, so a model's error is not in it, and the noise is
// white.
#include "recovery/twins.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <map>

#include "base/normal.h"
#include "fit/identifiability.h"
#include "servodx/table.h"
#include "tune/tune.h"

using namespace servodx;

int main(int argc, char** argv) {
  const int seeds = argc > 1 ? std::atoi(argv[1]) : 20, threads = argc > 2 ? std::atoi(argv[2]) : 0;
  for (int n : {8, 15, 25}) {
    struct Count {
      int inside = 0, stated = 0, dropped = 0, at_bound = 0;
      double z2 = 0;
      std::string z;
    };
    std::map<std::string, Count> counts;
    Count all;
    const auto start = std::chrono::steady_clock::now();
    long simulations = 0;
    for (int seed = 1; seed <= seeds; ++seed) {
      const twins::Twin twin =
          twins::make(n, static_cast<std::uint64_t>(seed), {"healthy/h01_steps_large", "healthy/h12_mixed"}, 2000);
      const TuneResult result = twins::tuned(twin, threads);
      simulations += result.simulations;
      for (const twins::Outcome& o : twins::outcomes(twin, result)) {
        for (Count* c : {&counts[o.name], &all}) {
          const bool stated = twins::identifiable(o), at_bound = o.verdict == RowVerdict::at_bound;
          c->stated += stated;
          c->inside += stated && std::abs(o.z) <= normal_95;
          c->at_bound += at_bound;
          c->dropped += !stated && !at_bound;
          if (stated) c->z2 += o.z * o.z, c->z += fmt::format(" {:.1f}", o.z);
        }
      }
      fmt::print(stderr, "{} rows, seed {}: pooled {} of {}\n", n, seed, all.inside, all.stated);
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    fmt::print("{} free rows, {} seeds, {:.0f} s, {} simulations\n", n, seeds, seconds, simulations);
    fmt::print("  {:<26} {:>6} {:>6} {:>8} {:>8} {:>6}  z\n", "row", "inside", "stated", "dropped", "at bound",
               "rms z");
    for (const std::string& name : twins::rows()) {
      if (!counts.contains(name)) continue;
      const Count& c = counts[name];
      fmt::print("  {:<26} {:>6} {:>6} {:>8} {:>8} {:>6.2f} {}\n", name, c.inside, c.stated, c.dropped, c.at_bound,
                 std::sqrt(c.z2 / std::max(1, c.stated)), c.z);
    }
    fmt::print("  pooled: {} of {} inside, {:.1f} %; dropped {} of {}; at a bound {}\n\n", all.inside, all.stated,
               100.0 * all.inside / std::max(1, all.stated), all.dropped, n * seeds, all.at_bound);
    std::fflush(stdout);
  }
}
