#include "diagnose/whitening.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "fit/identifiability.h"
#include "fit/log_data.h"
#include "simulate/scenario.h"
#include "simulate/simulate.h"

namespace servodx {

void whiten(FitProblem& problem, int of_log, const ErrorModel& error, const Trajectory& reference) {
  const LogData& log = *problem.logs()[static_cast<std::size_t>(of_log)];
  for (std::size_t c = 0; c < log.channels.size(); ++c) {
    std::vector<double> sigma = channel_sigma(error, log, c, reference);
    const double scale = 1.0 / std::sqrt(effective_of(error.find(log.channels[c].signal), log.scenario.time));
    for (double& s : sigma) s *= scale;
    problem.set_sigma(of_log, static_cast<int>(c), std::move(sigma));
  }
}

std::vector<double> squares(const FitProblem& problem, const Eigen::VectorXd& residual, const ErrorModel& error) {
  const LogData& log = *problem.logs().front();
  std::vector<double> square(log.scenario.time.size(), 0.0);
  for (std::size_t c = 0; c < log.channels.size(); ++c) {
    const long at = problem.rows(0, static_cast<int>(c)).first;
    const double effective = effective_of(error.find(log.channels[c].signal), log.scenario.time);
    for (std::size_t k = 0; k < square.size(); ++k) {
      const double r = residual[at + static_cast<long>(k)];
      square[k] += r * r / effective / static_cast<double>(log.channels.size());
    }
  }
  return square;
}

std::vector<Trajectory> references_of(const LogData& log, const std::vector<const ParameterVector*>& candidates,
                                      int threads) {
  SimulateOptions options;
  options.threads = threads;
  options.wanted.fill(false);
  for (const FitChannel& c : log.channels) options.wanted[c.simulated] = true;
  std::vector<Trajectory> out(candidates.size());
  std::vector<Job> jobs;
  for (std::size_t i = 0; i < candidates.size(); ++i) jobs.push_back({&log.scenario, candidates[i], &out[i]});
  simulate(jobs, options);
  return out;
}

Trajectory reference_of(const LogData& log, const ParameterVector& base, int threads) {
  return std::move(references_of(log, {&base}, threads).front());
}

}  // namespace servodx
