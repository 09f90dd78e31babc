#include "fit/stand.h"

#include <algorithm>
#include <cmath>

#include "base/celsius.h"
#include "base/two_pi.h"
#include "fit/constants.h"
#include "fit/oil_of.h"
#include "model/state.h"
#include "parameters/list.h"
#include "servodx/log.h"

namespace servodx {
namespace {

using namespace fit_constants;

Scenario at_stand(const RigFile& rig) {
  Scenario s;
  s.ports = Ports::free;
  s.oil = oil_of(rig.fluid, reference_oil_temperature);
  s.spool_start = 0;
  return s;
}

}  // namespace

StandTest step_test(const RigFile& rig, double rated, double amplitude, double stated) {
  StandTest test{at_stand(rig)};
  const double h = stated / samples_a_rise;
  test.first = static_cast<std::size_t>(rest_before_step * samples_a_rise);
  const auto n = test.first + static_cast<std::size_t>(seen_after_step * samples_a_rise) + 1;
  for (std::size_t k = 0; k < n; ++k) {
    test.scenario.time.push_back(static_cast<double>(k) * h);
    test.scenario.command.push_back(k < test.first ? 0 : amplitude * rated);
  }
  test.scenario.command_slope = 0;
  test.scenario.rated_current = rated;
  return test;
}

StandTest sine_test(const RigFile& rig, double rated, double amplitude, double frequency, int cycles) {
  StandTest test{at_stand(rig), frequency};
  test.first = static_cast<std::size_t>(cycles * samples_a_cycle);
  for (std::size_t k = 0; k <= 2 * test.first; ++k) {
    const double turn = static_cast<double>(k) / samples_a_cycle;
    test.scenario.time.push_back(turn / frequency);
    test.scenario.command.push_back(amplitude * rated * std::sin(two_pi * turn));
  }
  test.scenario.command_slope = 1;
  test.scenario.rated_current = rated;
  return test;
}

int settling_cycles(double frequency) {
  return std::max(least_cycles, static_cast<int>(std::ceil(settled_after * frequency)));
}

std::vector<std::vector<std::vector<double>>> spools(const std::vector<StandTest>& tests,
                                                     const std::vector<ParameterVector>& candidates) {
  const std::size_t n = candidates.size();
  std::vector<Trajectory> runs(n * tests.size());
  std::vector<Job> jobs;
  for (std::size_t test = 0; test < tests.size(); ++test)
    for (std::size_t k = 0; k < n; ++k) jobs.push_back({&tests[test].scenario, &candidates[k], &runs[test * n + k]});
  const auto spool = static_cast<std::size_t>(simulated_index(Signal::spool_position));
  SimulateOptions how;  // the usual steps: finer ones move no figure by a tenth of a per cent
  how.wanted.fill(false);
  how.wanted[spool] = true;
  simulate(jobs, how);
  std::vector<std::vector<std::vector<double>>> out(tests.size(), std::vector<std::vector<double>>(n));
  for (std::size_t test = 0; test < tests.size(); ++test)
    for (std::size_t k = 0; k < n; ++k)
      if (Trajectory& run = runs[test * n + k]; run.ok) out[test][k] = std::move(run.signals[spool]);
  return out;
}

std::complex<double> response(const StandTest& test, const std::vector<double>& spool) {
  std::complex<double> in = 0, out = 0;
  for (std::size_t k = test.first; k + 1 < spool.size(); ++k) {
    const auto turn = std::polar(1.0, -two_pi * test.frequency * test.scenario.time[k]);
    in += turn * test.scenario.command[k];
    out += turn * spool[k];
  }
  return out / in;
}

double rated_current(const RigFile& rig, const ParameterVector& candidate) {
  return rig.fact("valve.rated_current").value_or(candidate[row::current_limit] / stated::limit_over_rated);
}

}  // namespace servodx
