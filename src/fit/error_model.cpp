#include "fit/error_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/tiny.h"
#include "fit/constants.h"
#include "fit/log_data.h"
#include "optimise/unit_cube.h"
#include "parameters/table.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

using namespace fit_constants::learnt;

double square(double x) { return x * x; }

}  // namespace

const ChannelError* ErrorModel::find(Signal s) const {
  for (const ChannelError& c : channels)
    if (c.signal == s) return &c;
  return nullptr;
}

std::vector<double> activity(const std::vector<double>& time, const std::vector<double>& simulated) {
  std::vector<double> a(simulated.size(), 0.0);
  double memory = 0;
  for (std::size_t k = 1; k < simulated.size(); ++k) {
    const double dt = time[k] - time[k - 1];
    const double keep = std::exp(-dt / activity_time);
    const double speed = std::abs(simulated[k] - simulated[k - 1]) / dt * 1e-3;
    memory = std::sqrt(keep * memory * memory + (1.0 - keep) * speed * speed);
    a[k] = memory;
  }
  return a;
}

std::vector<double> sigma_of(const ChannelError* error, double noise, const std::vector<double>& act) {
  std::vector<double> s(act.size(), noise);
  if (error)
    for (std::size_t k = 0; k < s.size(); ++k)
      s[k] = std::sqrt(square(noise) + square(error->floor) + square(error->per_activity * act[k]));
  return s;
}

std::vector<Note> leave_out_unknown_channels(LogData& log, const ErrorModel& model) {
  std::vector<Note> notes;
  std::erase_if(log.channels, [&](const FitChannel& c) {
    if (model.find(c.signal)) return false;
    notes.push_back(
        {Note::Kind::unlearnt_signal,
         fmt::format("{}: {} is left out: no tuning log held it, so how far the model is off there is not known; tune "
                     "with logs that have it",
                     log.path, info(c.signal).name)});
    return true;
  });
  return notes;
}

std::vector<double> channel_sigma(const ErrorModel& model, const LogData& log, std::size_t channel,
                                  const Trajectory& run) {
  const FitChannel& of = log.channels[channel];
  std::vector<double> act = activity(log.scenario.time, run.ok ? run.signals[of.simulated] : of.measured);
  for (double& a : act)
    if (std::isnan(a)) a = 0;
  return sigma_of(model.find(of.signal), of.noise, act);
}

double effective_of(const ChannelError* error, const std::vector<double>& time) {
  const double span = time.empty() ? 0.0 : time.back() - time.front();
  if (!(span > 0)) return 1.0;
  const double rate = static_cast<double>(time.size() - 1) / span;
  return std::min(1.0, (error ? error->independent : unlearnt_independent) / rate);
}

double effective_fraction(const std::vector<double>& w) {
  std::vector<double> x;
  for (double v : w)
    if (!std::isnan(v)) x.push_back(v);
  const std::size_t n = x.size();
  if (n < fewest) return 1.0;
  double c0 = 0;
  for (double v : x) c0 += v * v;
  if (c0 <= 0) return 1.0;
  double tau = 1.0;
  // Sums of neighbouring pairs stay positive for a reversible chain; the first negative one ends the sum.
  for (std::size_t lag = 1; lag + 1 < n / 2; lag += 2) {
    double c = 0;
    for (std::size_t k = 0; k + lag < n; ++k) c += x[k] * x[k + lag];
    for (std::size_t k = 0; k + lag + 1 < n; ++k) c += x[k] * x[k + lag + 1];
    if (c <= 0) break;
    tau += 2.0 * c / c0;
  }
  return std::clamp(1.0 / tau, 1.0 / static_cast<double>(n), 1.0);
}

namespace {

// What the logs that have a channel say of it.
struct PooledChannel {
  std::vector<std::vector<double>> residuals, activities;  // [log][sample]
  std::vector<double> noises, rates;                       // [log] [SI], [1/s]
};

PooledChannel pooled(const FitProblem& problem, const std::vector<Trajectory>& t, Signal signal) {
  PooledChannel out;
  for (std::size_t l = 0; l < t.size(); ++l) {
    if (!t[l].ok) continue;
    const auto& channels = problem.logs()[l]->channels;
    const std::vector<double>& time = problem.logs()[l]->scenario.time;
    for (std::size_t c = 0; c < channels.size(); ++c)
      if (channels[c].signal == signal) {
        out.residuals.push_back(problem.raw_residual(static_cast<int>(l), static_cast<int>(c), t[l]));
        out.activities.push_back(activity(time, t[l].signals[channels[c].simulated]));
        out.noises.push_back(channels[c].noise);
        out.rates.push_back(static_cast<double>(time.size() - 1) / (time.back() - time.front()));
      }
  }
  return out;
}

// -2 ln of likelihood and prior of a channel's floor and slope, over the samples. Each log weighs the same in it: a
// long quiet one must not drown a short lively one.
class ChannelCost {
 public:
  explicit ChannelCost(const PooledChannel& channel) : channel_(channel) {
    double sum_r2 = 0, sum_a2 = 0, n = 0;
    for (std::size_t i = 0; i < channel.residuals.size(); ++i)
      for (std::size_t k = 0; k < channel.residuals[i].size(); ++k)
        if (!std::isnan(channel.residuals[i][k]))
          sum_r2 += square(channel.residuals[i][k]), sum_a2 += square(channel.activities[i][k]), ++n;
    rms = std::sqrt(sum_r2 / n), rms_activity = std::sqrt(sum_a2 / n);
  }
  double operator()(double floor, double slope) const {
    double total = 0;
    for (std::size_t i = 0; i < channel_.residuals.size(); ++i) {
      double one = 0;
      long count = 0;
      for (std::size_t k = 0; k < channel_.residuals[i].size(); ++k) {
        if (std::isnan(channel_.residuals[i][k])) continue;
        const double s2 = square(channel_.noises[i]) + square(floor) + square(slope * channel_.activities[i][k]);
        one += std::log(s2) + square(channel_.residuals[i][k]) / s2;
        ++count;
      }
      total += one / static_cast<double>(std::max(1L, count));
    }
    for (double share : {floor / rms, slope * rms_activity / rms})
      total += square(std::log(std::sqrt(2.0) * share)) / square(prior_spread) / log_worth;
    return total;
  }
  double rms = 0, rms_activity = 0;  // of all logs' samples

 private:
  const PooledChannel& channel_;
};

// Floor and slope of the least cost. Two numbers, a smooth bowl in their logs: coarse grid, then halving.
std::pair<double, double> descend(const ChannelCost& cost) {
  const double rms = cost.rms, rms_activity = cost.rms_activity;
  double lf = std::log(std::max(rms, tiny)), ls = std::log(rms / std::max(rms_activity, tiny));
  double best = cost(std::exp(lf), std::exp(ls));
  for (double step = first_step; step > last_step; step *= 0.5)
    for (bool moved = true; moved;) {
      moved = false;
      for (const auto& [df, ds] : {std::pair{step, 0.0}, {-step, 0.0}, {0.0, step}, {0.0, -step}}) {
        const double trial = cost(std::exp(lf + df), std::exp(ls + ds));
        if (trial < best - least_fall && lf + df > std::log(rms) - lowest &&
            ls + ds > std::log(rms / rms_activity) - lowest)
          best = trial, lf += df, ls += ds, moved = true;
      }
    }
  return {std::exp(lf), std::exp(ls)};
}

// By the mean over the logs of how long their errors last: one that shows nothing but white noise must not hide the
// others'. [1/s]
double independent_rate(const PooledChannel& channel, const ChannelError& error) {
  double correlation_time = 0;  // [s]
  for (std::size_t i = 0; i < channel.residuals.size(); ++i) {
    const std::vector<double> sigma = sigma_of(&error, channel.noises[i], channel.activities[i]);
    std::vector<double> whitened(channel.residuals[i].size());
    for (std::size_t k = 0; k < whitened.size(); ++k) whitened[k] = channel.residuals[i][k] / sigma[k];
    correlation_time +=
        1 / (effective_fraction(whitened) * channel.rates[i] * static_cast<double>(channel.residuals.size()));
  }
  return 1 / correlation_time;
}

}  // namespace

ErrorModel learn_error_model(const FitProblem& problem, const Point& x) {
  const std::vector<Trajectory> t = problem.trajectories(x);
  ErrorModel model;
  for (Signal signal : simulated_signals) {
    const PooledChannel channel = pooled(problem, t, signal);
    if (channel.residuals.empty()) continue;
    const auto [floor, slope] = descend(ChannelCost(channel));
    ChannelError error{signal, floor, slope, 0.0};
    error.independent = independent_rate(channel, error);
    model.channels.push_back(error);
  }
  return model;
}

namespace {

// Of `alike` logs the error is one, each log's noise its own.
double beside_repeats(double sigma, double noise, int alike) {
  return std::sqrt(square(noise) + alike * std::max(0.0, square(sigma) - square(noise)));
}

}  // namespace

void apply_error_model(FitProblem& problem, const ErrorModel& model, const Point& x, bool each_log) {
  const std::vector<Trajectory> t = problem.trajectories(x);
  for (std::size_t l = 0; l < t.size(); ++l) {
    const LogData& log = *problem.logs()[l];
    for (std::size_t c = 0; c < log.channels.size(); ++c) {
      const ChannelError* error = model.find(log.channels[c].signal);
      std::vector<double> sigma = channel_sigma(model, log, c, t[l]);
      const double fraction = effective_of(error, log.scenario.time);
      double scale = 1.0 / std::sqrt(fraction);
      if (each_log && t[l].ok) {
        const std::vector<double> residual = problem.raw_residual(static_cast<int>(l), static_cast<int>(c), t[l]);
        double sum = 0, n = 0;
        for (std::size_t k = 0; k < residual.size(); ++k)
          if (!std::isnan(residual[k])) sum += square(residual[k] / sigma[k]), ++n;
        scale *= std::sqrt((prior_worth + fraction * sum) / (prior_worth + fraction * n));
      }
      for (double& s : sigma) s = scale * beside_repeats(s, log.channels[c].noise, log.alike);
      problem.set_sigma(static_cast<int>(l), static_cast<int>(c), std::move(sigma));
    }
  }
}

}  // namespace servodx
