#include "fit/replay.h"

#include <cmath>

#include "fit/fast_log.h"
#include "fit/log_data.h"
#include "fit/problem.h"
#include "fit/tuned_state.h"
#include "parameters/table.h"
#include "servodx/rig.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

// `v`, with NaN in front so that it ends where a series of `samples` ends.
std::vector<double> behind_gap(std::size_t samples, const std::vector<double>& v) {
  std::vector<double> all(samples - v.size(), std::nan(""));
  all.insert(all.end(), v.begin(), v.end());
  return all;
}

}  // namespace

Replay replay(const Log& log, const Table& tuned, const RigFile& rig, const std::vector<Candidate>& explanations) {
  const TunedState state = tuned_state(tuned);
  const LogData data = prepare_at_points(log, rig, state.recorder);
  const ErrorModel& error = state.error;
  const std::size_t samples = data.scenario.time.size();
  Replay out{log.path, data.scenario.time, data.scenario.command, data.scenario.current_measured, {}};
  for (const FitChannel& c : data.channels)
    out.channels.push_back({c.signal, log.channels[index(c.signal)].unit, c.measured, {}, {}});
  for (const Candidate& e : explanations) {
    if (e.candidate.empty()) continue;  // a hypothesis that could not be fitted
    const LogData part = e.from > 0 ? slice(data, e.from, samples) : data;
    const FitProblem problem({&part}, e.candidate, {});
    const Trajectory t = problem.trajectories({}).front();
    if (!t.ok) continue;
    for (std::size_t c = 0; c < data.channels.size(); ++c) {
      const std::vector<double> simulated = part.channels[c].shown(t.signals[data.channels[c].simulated]);
      out.channels[c].simulated.push_back({e.name, behind_gap(samples, simulated),
                                           behind_gap(samples, problem.raw_residual(0, static_cast<int>(c), t))});
      if (out.channels[c].sigma.empty() && e.from == 0)
        out.channels[c].sigma = sigma_of(error.find(data.channels[c].signal), data.channels[c].noise,
                                         activity(data.scenario.time, simulated));
    }
  }
  return out;
}

}  // namespace servodx
