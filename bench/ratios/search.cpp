// Simulations until a fit stands within 1.05 of its floor, ours and the best of the peers: on the model's own noisy
// runs, whose floor is the truth's, and on the virtual rig's logs, whose floor is the least that anyone has found.
#include <fmt/format.h>

#include "optimise/box_least_squares.h"
#include "ratios/measure.h"
#include "ratios/peers.h"
#include "ratios/race.h"
#include "ratios/twin.h"

namespace servodx::bench {
namespace {

constexpr double seconds = 5.0;

Objective objective_of(const Twin& twin) {
  return {twin.n, twin.goal(), [&twin](std::span<const Point> points) { return twin.evaluate(points); }};
}

}  // namespace

void search_rows(Report& report, const Choice& choice) {
  const Scenario scenario = trace(seconds);
  for (const std::string& why : missing_peers()) report.excuse("best_peer", why);
  for (const int n : choice.free) {
    std::vector<Twin> twins;
    std::vector<Objective> objectives;
    for (int seed = 1; seed <= choice.seeds; ++seed) twins.emplace_back(n, seed, scenario, 0);
    int redrawn = 0;
    for (const Twin& twin : twins) objectives.push_back(objective_of(twin)), redrawn += twin.redrawn;
    race(report, choice, "", "", objectives, {{"truths_drawn_again", redrawn}});
  }
}

void virtual_rows(Report& report, const Choice& asked) {
  Choice choice = asked;
  if (!asked.peers_on_logs) {
    choice.peer_budget = 0;
    report.excuse("virtual_rig_best_peer", "takes most of an hour: --only virtual");
  }
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
    // The floor: the best of a long search of ours.
    std::vector<double> goals;
    for (const LogData& log : logs) {
      const Twin fit(n, log, 0);
      Objective o = objective_of(fit);
      double least = 1e300;
      o.goal = -1;
      ours(o, 1000, choice.floor_search, &least);
      goals.push_back(1.05 * least);
    }
    std::vector<Twin> fits;
    std::vector<Objective> by_seed;
    for (int seed = 0; seed < choice.seeds; ++seed) fits.emplace_back(n, logs[seed % logs.size()], 0);
    for (const Twin& fit : fits)
      by_seed.push_back(objective_of(fit)), by_seed.back().goal = goals[(by_seed.size() - 1) % logs.size()];
    race(report, choice, ", virtual rig", "virtual_rig_", by_seed);
  }
}

}  // namespace servodx::bench
