#include "diagnose/hypotheses.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "fit/free_values.h"
#include "fit/identifiability.h"
#include "simulate/together.h"

namespace servodx {
namespace {

// Severity as a free number, from the mildest that is called a fault to the worst, on the side of the start.
FreeValue severity_value(const Fault& fault, double start, double null_limit) {
  FreeValue f;
  f.name = "severity";
  f.apply = fault.apply;
  f.log_scale = fault.log_scale;
  double least = fault.name == "null_shift" ? null_limit : fault.least, worst = fault.worst;
  if (start < 0) least = -least, worst = -worst;
  f.lower = std::min(least, worst);
  f.upper = std::max(least, worst);
  f.start = std::clamp(start, f.lower, f.upper);
  return f;
}

bool two_sided(const Fault& fault) {
  return std::any_of(fault.starts.begin(), fault.starts.end(), [](double s) { return s < 0; });
}

// The same severity within its tolerance. Where the healthy value is an end of the scale (nothing is less than clean),
// the tolerance has one side.
FreeValue tolerance_value(const Fault& fault) {
  FreeValue f;
  f.name = std::string("tolerance of ") + std::string(fault.name);
  f.apply = fault.apply;
  f.log_scale = fault.log_scale;
  f.start = fault.healthy;
  f.log = 0;
  if (fault.log_scale) {
    f.lower = std::min(fault.least, fault.healthy * fault.healthy / fault.least);
    f.upper = std::max(fault.least, fault.healthy * fault.healthy / fault.least);
    f.prior_sd = 0.25;
  } else if (fault.healthy != 0) {
    const double width = std::abs(fault.least - fault.healthy);
    f.lower = fault.healthy - width, f.upper = fault.healthy + width;
    f.prior_sd = 0.25;
  } else if (two_sided(fault)) {
    f.lower = -fault.least, f.upper = fault.least;
    f.prior_sd = 0.25;
  } else {
    f.lower = 0, f.upper = fault.least;
    f.prior_sd = 0.5;
  }
  return f;
}

std::vector<FreeValue> free_values(const LogData& log, const ParameterVector& base, const Fault* fault, double start,
                                   double null_limit) {
  std::vector<FreeValue> free;
  if (fault) free.push_back(severity_value(*fault, start, null_limit));
  for (FreeValue& f : nuisance_values(log, 0, base, null_limit))
    if (!(fault && fault->name == "null_shift" && f.at == row::servovalve_null)) free.push_back(std::move(f));
  // A null within its limit is a nuisance already.
  for (const Fault* other : fault_list())
    if (other != fault && other->name != "null_shift") free.push_back(tolerance_value(*other));
  return free;
}

void whiten(FitProblem& problem, const ErrorModel& error, const Trajectory& reference) {
  const LogData& log = *problem.logs().front();
  for (std::size_t c = 0; c < log.channels.size(); ++c) {
    const FitChannel& channel = log.channels[c];
    const ChannelError* e = error.find(channel.signal);
    std::vector<double> act =
        activity(log.scenario.time, reference.ok ? reference.signals[channel.simulated] : channel.measured);
    for (double& a : act)
      if (std::isnan(a)) a = 0;
    std::vector<double> sigma = sigma_of(e, channel.noise, act);
    const double scale = 1.0 / std::sqrt(effective_of(e, log.scenario.time));
    for (double& s : sigma) s *= scale;
    problem.set_sigma(0, static_cast<int>(c), std::move(sigma));
  }
}

// A sample: mean over the channels of the squared whitened residual.
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

// The trajectory at the tuned values: it says where things move, and so where the model may err, for all alike.
Trajectory reference_of(const LogData& log, const ParameterVector& base, int threads) {
  SimulateOptions options;
  options.threads = threads;
  options.wanted.fill(false);
  for (const FitChannel& c : log.channels) options.wanted[c.simulated] = true;
  return simulate(log.scenario, base, options);
}

struct Attempt {
  const Fault* fault = nullptr;
  double start = 0;
  HypothesisFit fit;
  std::vector<double> square;
  long simulations = 0, failed = 0;
};

// The point to begin at: where this attempt got to before, else the severity's start and, for the rest, what health
// came to.
Point starting_point(const Attempt& a, const FitProblem& problem, const HypothesisFit* healthy) {
  if (a.fit.ok) return a.fit.point;
  Point x = problem.start();
  if (healthy && healthy->ok)
    for (std::size_t j = 0; j < x.size(); ++j)
      for (std::size_t k = 0; k < healthy->free.size(); ++k)
        if (problem.free()[j].name == healthy->free[k].name) x[j] = healthy->point[k];
  return x;
}

void run(Attempt& a, const LogData& log, const ParameterVector& base, const ErrorModel& error,
         const Trajectory& reference, const HypothesisFit* healthy, int iterations,
         const HypothesisSettings& settings) {
  const auto stopped = [&] { return settings.stop && settings.stop->load(); };
  if (stopped()) return;
  SimulateOptions simulate_options;
  simulate_options.threads = 1;
  HypothesisFit& fit = a.fit;
  fit.fault = a.fault;
  fit.free = free_values(log, base, a.fault, a.start, settings.null_limit);
  FitProblem problem({&log}, base, fit.free, simulate_options);
  problem.difference_step = 1e-3;  // a severity runs through contacts; its scale is the whole range
  whiten(problem, error, reference);
  LeastSquaresOptions o;
  o.max_iterations = iterations;
  o.difference = Difference::forward;
  o.cost_tolerance = 1e-4;
  o.damping_trials = 1;  // the hypotheses fill each other's packs: no lane is free
  o.progress = [&](const LeastSquaresProgress&) { return !stopped(); };
  const LeastSquaresResult r = minimise_least_squares(problem.least_squares(), starting_point(a, problem, healthy), o);
  a.simulations += problem.simulations();
  a.failed += problem.failed_simulations();
  fit.stops = {r.stopped};
  fit.standard_error.clear(), fit.channel_adequacy.clear(), fit.channel_rms.clear();
  if (r.reason == StopReason::start_failed) return;
  fit.ok = true;
  fit.misfit = 2 * r.misfit;
  fit.point = r.point;
  std::vector<char> kept(fit.free.size());
  for (std::size_t j = 0; j < kept.size(); ++j)
    kept[j] = (a.fault && j == 0) || (r.point[j] > 1e-6 && r.point[j] < 1 - 1e-6);
  const Eigen::MatrixXd covariance = covariance_of(r.jacobian, kept);
  for (std::size_t j = 0; j < kept.size(); ++j)
    fit.standard_error.push_back(std::sqrt(std::max(0.0, covariance(static_cast<long>(j), static_cast<long>(j)))));
  const std::size_t samples = log.scenario.time.size();
  a.square = squares(problem, r.residual, error);
  for (std::size_t c = 0; c < log.channels.size(); ++c) {
    const auto [at, n] = problem.rows(0, static_cast<int>(c));
    const ChannelError* e = error.find(log.channels[c].signal);
    const double effective = effective_of(e, log.scenario.time);
    const auto present = static_cast<double>(std::max(1L, present_samples(log.channels[c])));
    fit.channel_adequacy.push_back(std::sqrt(r.residual.segment(at, n).squaredNorm() / present / effective));
    double raw = 0;
    for (std::size_t k = 0; k < samples; ++k) {
      const double v = r.residual[at + static_cast<long>(k)] * problem.sigma(0, static_cast<int>(c))[k];
      raw += v * v;
    }
    fit.channel_rms.push_back(std::sqrt(raw / present));
  }
  if (a.fault) {
    // The curvature at the end, inflated where the model does not fit as well as it should, and the fault's own spread.
    const double worst = *std::max_element(fit.channel_adequacy.begin(), fit.channel_adequacy.end());
    const double range =
        a.fault->log_scale ? std::log(fit.free[0].upper / fit.free[0].lower) : fit.free[0].upper - fit.free[0].lower;
    const double half = 1.96 * std::hypot(fit.standard_error[0] * std::max(1.0, worst), a.fault->spread / range);
    fit.severity = fit.free[0].from_unit(r.point[0]);
    const auto beyond_health = [&](double u) { return std::abs(fit.free[0].from_unit(u) - a.fault->healthy); };
    constexpr double close = 1e-3;  // of the range that was searched
    fit.at_least = std::abs(r.point[0] - (beyond_health(0.0) < beyond_health(1.0) ? 0.0 : 1.0)) < close;
    fit.severity_lower = fit.free[0].from_unit(std::clamp(r.point[0] - half, 0.0, 1.0));
    fit.severity_upper = fit.free[0].from_unit(std::clamp(r.point[0] + half, 0.0, 1.0));
  }
}

// Severities to begin at: the fault's own identifiers and an even grid over its range. Lanes are cheap, and a friction
// or a backlash has more than one valley.
std::vector<double> grid_of(const Fault& fault, double null_limit) {
  constexpr int grid = 6;
  std::vector<double> severities = fault.starts;
  for (double side : {1.0, -1.0}) {
    if (side < 0 && !two_sided(fault)) continue;
    const FreeValue range = severity_value(fault, side, null_limit);
    for (int k = 0; k < grid; ++k) severities.push_back(range.from_unit((k + 0.5) / grid));
  }
  return severities;
}

struct Screened {
  double severity = 0, misfit = 1e300;  // with the rest as in health
  long simulations = 0, failed = 0;
};

void screen(Screened& s, const Fault& fault, const LogData& log, const ParameterVector& base, const ErrorModel& error,
            const Trajectory& reference, const HypothesisFit& healthy, const HypothesisSettings& settings) {
  SimulateOptions options;
  options.threads = 1;
  // The unit interval of a severity depends on its sign.
  FitProblem problem({&log}, base, free_values(log, base, &fault, s.severity, settings.null_limit), options);
  whiten(problem, error, reference);
  const Point x = starting_point({&fault, s.severity, {}, {}, 0, 0}, problem, &healthy);
  const Evaluation e = problem.evaluate(std::span(&x, 1)).front();
  if (e.ok) s.misfit = e.residual.squaredNorm();
  s.simulations = problem.simulations(), s.failed = problem.failed_simulations();
}

}  // namespace

HypothesisFits fit_hypotheses(const LogData& log, const ParameterVector& base, const ErrorModel& error,
                              const HypothesisSettings& settings) {
  HypothesisFits out;
  const Trajectory reference = reference_of(log, base, settings.threads);
  const auto& faults = settings.among.empty() ? fault_list() : settings.among;
  // Work counted in steps of least squares: a screening is about one, and few begin again.
  constexpr int few = 5;
  constexpr double screening = 1, again_part = 2;
  const double whole = settings.iterations + static_cast<double>(faults.size()) *
                                                 (screening + 2.0 * few + (settings.iterations - few) + again_part);
  std::atomic<double> done = 0;
  std::atomic<long> simulated = 0;
  const auto worked = [&](double steps, long simulations) {
    const double so_far = done.fetch_add(steps) + steps;
    const long all = simulated.fetch_add(simulations) + simulations;
    if (settings.progress) settings.progress(std::min(1.0, so_far / whole), all);
  };
  Attempt health;
  run(health, log, base, error, reference, nullptr, settings.iterations, settings);
  worked(settings.iterations, health.simulations);
  // Side by side in the same packs, as many as memory holds: a fit keeps some 1.4 kB a sample.
  constexpr std::size_t samples_at_once = 1'000'000;
  const auto group = static_cast<int>(std::max<std::size_t>(2, samples_at_once / log.scenario.time.size()));
  const auto each = [&](std::size_t count, const std::function<void(std::size_t)>& task) {
    const int n = static_cast<int>(count);
    for (int first = 0; first < n; first += group)
      together(std::min(group, n - first), settings.threads, [&](int i) { task(static_cast<std::size_t>(first + i)); });
  };
  std::vector<std::pair<const Fault*, Screened>> screened;
  for (const Fault* fault : faults)
    for (double severity : grid_of(*fault, settings.null_limit)) screened.push_back({fault, {severity}});
  each(screened.size(), [&](std::size_t k) {
    auto& [fault, s] = screened[k];
    screen(s, *fault, log, base, error, reference, health.fit, settings);
    worked(screening * static_cast<double>(faults.size()) / static_cast<double>(screened.size()), s.simulations);
  });
  std::stable_sort(screened.begin(), screened.end(),
                   [](const auto& a, const auto& b) { return a.second.misfit < b.second.misfit; });
  constexpr int kept = 2;
  std::vector<Attempt> attempts;
  for (const Fault* fault : faults) {
    int begun = 0;
    for (const auto& [of, s] : screened)
      if (of == fault && begun < kept && (begun == 0 || s.misfit < 1e300))
        attempts.push_back({fault, s.severity, {}, {}, 0, 0}), ++begun;
  }
  const auto all = [&](int iterations) {
    each(attempts.size(), [&](std::size_t k) {
      Attempt& a = attempts[k];
      const long before = a.simulations;
      run(a, log, base, error, reference, &health.fit, iterations, settings);
      worked(iterations, a.simulations - before);
    });
  };
  // Every start gets a few steps; the best of each fault goes on.
  constexpr double worth_another_start = 4.0;  // of misfit: two deviates
  all(few);
  out.simulations = health.simulations, out.failed = health.failed;
  for (const auto& [fault, s] : screened) out.simulations += s.simulations, out.failed += s.failed;
  std::vector<Attempt> best;
  for (Attempt& a : attempts) {
    if (best.empty() || best.back().fault != a.fault) {
      best.push_back(std::move(a));
      continue;
    }
    Attempt& b = best.back();
    const long simulations = a.simulations + b.simulations, failed = a.failed + b.failed;
    if (a.fit.ok && a.fit.misfit < b.fit.misfit) b = std::move(a);
    b.simulations = simulations, b.failed = failed;
  }
  attempts = std::move(best);
  all(settings.iterations - few);
  // Health had one start, the faults many: what one of them gained by better nuisances is no fault's. So health begins
  // again where each fault ended.
  std::vector<Attempt> again(attempts.size());
  each(again.size(), [&](std::size_t k) {
    const HypothesisFit& fault = attempts[k].fit;
    if (fault.ok && fault.misfit < health.fit.misfit - worth_another_start)
      run(again[k], log, base, error, reference, &fault, settings.iterations, settings);
    worked(again_part, again[k].simulations);
  });
  for (Attempt& a : again) {
    out.simulations += a.simulations, out.failed += a.failed;
    if (a.fit.ok && a.fit.misfit < health.fit.misfit)
      health.fit = std::move(a.fit), health.square = std::move(a.square);
  }
  out.healthy_square = std::move(health.square);
  out.fits.push_back(std::move(health.fit));
  for (Attempt& a : attempts) {
    out.simulations += a.simulations;
    out.failed += a.failed;
    out.fits.push_back(std::move(a.fit));
  }
  for (const FitChannel& c : log.channels) {
    out.degrees += static_cast<double>(present_samples(c)) * effective_of(error.find(c.signal), log.scenario.time);
  }
  return out;
}

std::vector<double> square_beyond_beginning(const LogData& log, std::size_t end, const ParameterVector& base,
                                            const ErrorModel& error, const HypothesisSettings& settings,
                                            long* simulations, long* failed) {
  const LogData beginning = slice(log, 0, end);
  Attempt health;
  run(health, beginning, base, error, reference_of(beginning, base, settings.threads), nullptr, settings.iterations,
      settings);
  *simulations += health.simulations;
  *failed += health.failed;
  if (!health.fit.ok) return {};
  FitProblem problem({&log}, base, health.fit.free);
  whiten(problem, error, reference_of(log, base, settings.threads));
  const Evaluation e = problem.evaluate(std::span(&health.fit.point, 1)).front();
  *simulations += problem.simulations();
  *failed += problem.failed_simulations();
  return e.ok ? squares(problem, e.residual, error) : std::vector<double>{};
}

}  // namespace servodx
