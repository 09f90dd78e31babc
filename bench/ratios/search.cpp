// Simulations until a fit stands within 1.05 of its floor, ours and the best of the peers: on the model's own noisy
// runs, whose floor is the truth's, and on the virtual rig's logs, whose floor is the least that anyone has found.
#include <fmt/format.h>

#include "fit/log_data.h"
#include "optimise/box_least_squares.h"
#include "optimise/unit_cube.h"
#include "ratios/measure.h"
#include "ratios/race.h"
#include "ratios/rows.h"
#include "ratios/twin.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "simulate/scenario.h"
#include "simulate/together.h"

namespace servodx::bench {
namespace {

constexpr double seconds = 5.0;

Objective objective_of(Twin twin) {
  return {twin.n, twin.goal(),
          [twin = std::move(twin)](std::span<const Point> points) { return twin.evaluate(points); }};
}

}  // namespace

void search_rows(Report& report, const Choice& choice) {
  const Scenario scenario = trace(seconds);
  for (const int n : choice.free) {
    std::vector<Objective> objectives;
    int redrawn = 0;
    for (int seed = 1; seed <= choice.seeds; ++seed) {
      const Twin twin(n, seed, scenario, 0);
      objectives.push_back(objective_of(twin));
      redrawn += twin.redrawn;
    }
    race(report, choice, "", "", objectives, {{"truths_drawn_again", redrawn}});
  }
}

void virtual_rows(Report& report, const Choice& choice) {
  const std::string folder = std::string(SERVODX_SOURCE_DIR) + "/data/";
  const RigFile rig = read_rig_file(folder + "rig.toml");
  std::vector<LogData> logs;
  for (const char* name : {"h05_prbs", "h10_flight", "h12_mixed"}) {
    const LogData whole = prepare(read_log(folder + "healthy/" + name + ".csv", rig), rig);
    const auto& t = whole.scenario.time;
    const auto end = std::lower_bound(t.begin(), t.end(), t.front() + seconds) - t.begin();
    logs.push_back(slice(whole, 0, static_cast<std::size_t>(end)));
  }
  for (const int n : choice.free) {
    std::vector<Objective> fits;
    for (const LogData& log : logs) fits.push_back(objective_of(Twin(n, log, 0)));
    // The floor: the best of a long search of ours.
    std::vector<double> goals(fits.size());
    together(static_cast<int>(fits.size()), 0, [&](int k) {
      Objective endless = fits[static_cast<std::size_t>(k)];
      endless.goal = -1;
      double least = 1e300;
      ours(endless, 1000, choice.floor_search, &least);
      goals[static_cast<std::size_t>(k)] = 1.05 * least;
    });
    std::vector<Objective> by_seed;
    for (int seed = 0; seed < choice.seeds; ++seed) {
      const std::size_t k = static_cast<std::size_t>(seed) % fits.size();
      by_seed.push_back(fits[k]);
      by_seed.back().goal = goals[k];
    }
    race(report, choice, ", virtual rig", "virtual_rig_", by_seed);
  }
}

}  // namespace servodx::bench
