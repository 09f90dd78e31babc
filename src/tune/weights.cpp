#include "tune/weights.h"

#include <algorithm>
#include <cmath>

#include "fit/log_data.h"
#include "simulate/scenario.h"
#include "tune/constants.h"

namespace servodx {

using namespace tune_constants;

double rms_of(const std::vector<double>& r, std::size_t from, std::size_t to) {
  double sum = 0;
  long n = 0;
  for (std::size_t k = from; k < to && k < r.size(); ++k)
    if (!std::isnan(r[k])) sum += r[k] * r[k], ++n;
  return n ? std::sqrt(sum / static_cast<double>(n)) : 0.0;
}

void first_whitening(FitProblem& problem, const Point& x) {
  const std::vector<Trajectory> t = problem.trajectories(x);
  for (std::size_t l = 0; l < t.size(); ++l) {
    const LogData& log = *problem.logs()[l];
    const double span = log.scenario.time.back() - log.scenario.time.front();
    const double correlated =
        static_cast<double>(log.scenario.time.size()) / std::max(1.0, span * least_independent_rate);
    for (std::size_t c = 0; c < log.channels.size(); ++c) {
      const int li = static_cast<int>(l), ci = static_cast<int>(c);
      const double r = t[l].ok ? rms_of(problem.raw_residual(li, ci, t[l]), 0, log.scenario.time.size())
                               : failed_over_noise * log.channels[c].noise;
      problem.set_sigma(
          li, ci,
          std::max(least_over_noise * log.channels[c].noise, part_of_residual * r * std::sqrt(log.alike)) *
              std::sqrt(std::max(1.0, correlated)));
    }
  }
}

void weigh_sweeps(FitProblem& problem, const Point& x) {
  const std::vector<Trajectory> t = problem.trajectories(x);
  double samples = 0, sweeps = 0;
  for (const LogData* log : problem.logs())
    for (const FitChannel& c : log->channels) samples += static_cast<double>(c.measured.size()), sweeps += 1;
  for (std::size_t l = 0; l < t.size(); ++l) {
    const LogData& log = *problem.logs()[l];
    for (std::size_t c = 0; c < log.channels.size(); ++c) {
      const int li = static_cast<int>(l), ci = static_cast<int>(c);
      const std::size_t n = log.channels[c].measured.size();
      const double r =
          t[l].ok ? rms_of(problem.raw_residual(li, ci, t[l]), 0, n) : failed_over_noise * log.channels[c].noise;
      problem.set_sigma(li, ci,
                        std::max(log.channels[c].noise, r) * std::sqrt(static_cast<double>(n) / (samples / sweeps)));
    }
  }
}

}  // namespace servodx
