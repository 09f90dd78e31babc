#include "plan/test_bench.h"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/celsius.h"
#include "diagnose/whitening.h"
#include "fit/problem.h"
#include "fit/tuned_state.h"
#include "plan/constants.h"
#include "servodx/note.h"
#include "simulate/simulate.h"

namespace servodx {
namespace {

namespace k = plan_constants;

constexpr std::size_t pattern_samples = 64;

// A log of the tuning logs' sensors that shows nothing.
Log blank_log(const ErrorModel& error, double rate) {
  Log log;
  log.path = "the planned test";
  for (std::size_t n = 0; n < pattern_samples; ++n) log.time.push_back(static_cast<double>(n) / rate);
  const auto fill = [&](Signal s, double value) { log.channels[index(s)].value.assign(pattern_samples, value); };
  fill(Signal::command, 0);
  fill(Signal::oil_temperature, reference_oil_temperature);
  for (const ChannelError& e : error.channels) fill(e.signal, 0);
  return log;
}

double mean(const std::vector<double>& x) {
  double sum = 0;
  for (const double v : x) sum += v;
  return sum / static_cast<double>(x.size());
}

double largest(const std::vector<double>& x) {
  double most = 0;
  for (const double v : x) most = std::max(most, std::abs(v));
  return most;
}

std::vector<double> slope(const std::vector<double>& x, double rate) {
  std::vector<double> v(x.size(), 0.0);
  for (std::size_t n = 1; n + 1 < x.size(); ++n) v[n] = (x[n + 1] - x[n - 1]) * rate / 2;
  return v;
}

std::size_t unseen_samples(double rate) { return static_cast<std::size_t>(std::lround(k::unseen * rate)); }

const std::vector<double>& signal(const Trajectory& t, Signal s) {
  return t.signals[static_cast<std::size_t>(simulated_index(s))];
}

// How far health's lanes move a signal, each by one standard deviation, independent of one another.
double spread_of(const Trajectory& base, std::span<const Trajectory> lanes, const LaneSet& set, Signal s,
                 const std::function<std::vector<double>(const std::vector<double>&)>& of) {
  const std::vector<double> at = of(signal(base, s));
  double square = 0;
  for (const int j : set.health) {
    if (!lanes[static_cast<std::size_t>(j)].ok) continue;
    const std::vector<double> moved = of(signal(lanes[static_cast<std::size_t>(j)], s));
    double most = 0;
    for (std::size_t n = 0; n < at.size(); ++n) most = std::max(most, std::abs(moved[n] - at[n]));
    const double one = most * set.lanes[static_cast<std::size_t>(j)].scale;
    square += one * one;
  }
  return k::tolerance_deviates * std::sqrt(square);
}

PlannedTest::Extremes extremes_of(const LogData& log, const Trajectory& base, std::span<const Trajectory> lanes,
                                  const LaneSet& set, double rate) {
  PlannedTest::Extremes out;
  out.current = largest(log.scenario.command);
  if (log.scenario.ports != Ports::actuator) return out;
  const auto seen = [from = static_cast<long>(unseen_samples(rate))](const std::vector<double>& x) {
    return std::vector<double>(x.begin() + from, x.end());
  };
  const auto same = [&](const std::vector<double>& x) { return seen(x); };
  const auto speed = [&](const std::vector<double>& x) { return seen(slope(x, rate)); };
  const std::vector<double>& piston = signal(base, Signal::piston_position);
  out.stroke = largest(same(piston)) + spread_of(base, lanes, set, Signal::piston_position, same);
  out.speed = largest(speed(piston)) + spread_of(base, lanes, set, Signal::piston_position, speed);
  out.pressure_low = HUGE_VAL, out.pressure_high = -HUGE_VAL;
  for (const Signal s : {Signal::pressure_a, Signal::pressure_b}) {
    const std::vector<double> at = same(signal(base, s));
    const auto [low, high] = std::minmax_element(at.begin(), at.end());
    const double spread = spread_of(base, lanes, set, s, same);
    out.pressure_low = std::min(out.pressure_low, *low - spread);
    out.pressure_high = std::max(out.pressure_high, *high + spread);
  }
  out.cavitates = out.pressure_low < k::no_tension;
  out.pressure_low = std::max(out.pressure_low, k::no_tension);
  return out;
}

}  // namespace

TestBench::TestBench(const Table& tuned, const RigFile& rig, const Log* like, double rate, int threads)
    : rate_(rate), threads_(threads) {
  const TunedState state = tuned_state(tuned);
  error_ = state.error;
  pattern_ = prepare(like ? *like : blank_log(error_, rate), rig, state.recorder);
  if (like)
    notes_ = leave_out_unknown_channels(pattern_, error_);
  else
    notes_.push_back(
        {Note::Kind::no_log,
         "no log of the rig is given (--like): the test is judged with the sensors of the tuning logs, each "
         "as noisy as the model is wrong, and oil of 40 degC"});
  require_channels(pattern_);
  Scenario& s = pattern_.scenario;
  for (std::vector<double>* input : {&s.supply_pressure, &s.return_pressure, &s.load_force})
    if (!input->empty()) *input = {mean(*input)};
  s.spool_start.reset(), s.pressure_a_start.reset(), s.pressure_b_start.reset(), s.piston_start.reset();
  s.piston_velocity_start = 0;
  s.current_measured = false;
  for (FitChannel& c : pattern_.channels) {
    c.measured.clear();
    if (like) continue;
    const ChannelError* e = error_.find(c.signal);
    c.noise = e ? e->floor : 0;
  }
}

double TestBench::degrees(double seconds) const {
  std::vector<double> time;
  for (std::size_t n = 0; static_cast<double>(n) < seconds * rate_; ++n) time.push_back(static_cast<double>(n) / rate_);
  double sum = 0;
  for (const FitChannel& c : pattern_.channels)
    sum += static_cast<double>(time.size()) * effective_of(error_.find(c.signal), time);
  return sum;
}

LogData TestBench::log_of(const std::vector<double>& wave) const {
  LogData log = pattern_;
  Scenario& s = log.scenario;
  s.time.clear(), s.command.clear();
  for (std::size_t n = 0; n < wave.size(); ++n) {
    s.time.push_back(static_cast<double>(n) / rate_);
    s.command.push_back(wave[n] * s.rated_current);
  }
  for (std::vector<double>* input : {&s.supply_pressure, &s.return_pressure, &s.load_force})
    if (!input->empty()) input->assign(wave.size(), input->front());
  return log;
}

TestRun TestBench::measure(LogData log, const Trajectory& base, std::span<const Trajectory> lanes,
                           const LaneSet& set) const {
  TestRun out;
  if (!base.ok) return out;
  for (FitChannel& c : log.channels) {
    c.measured = c.shown(base.signals[static_cast<std::size_t>(c.simulated)]);
    std::fill_n(c.measured.begin(), unseen_samples(rate_), std::nan(""));
  }
  FitProblem problem({&log}, set.base, {});
  whiten(problem, 0, error_, base);
  const auto samples = static_cast<long>(log.scenario.time.size());
  Eigen::MatrixXd effect =
      Eigen::MatrixXd::Zero(samples * static_cast<long>(log.channels.size()), static_cast<long>(lanes.size()));
  for (std::size_t j = 0; j < lanes.size(); ++j)
    for (std::size_t c = 0; c < log.channels.size() && lanes[j].ok; ++c) {
      const std::vector<double> r = problem.raw_residual(0, static_cast<int>(c), lanes[j]);
      const std::vector<double>& sigma = problem.sigma(0, static_cast<int>(c));
      for (auto n = static_cast<long>(unseen_samples(rate_)); n < samples; ++n)
        effect(static_cast<long>(c) * samples + n, static_cast<long>(j)) =
            set.lanes[j].scale * r[static_cast<std::size_t>(n)] / sigma[static_cast<std::size_t>(n)];
    }
  out.gram = Eigen::MatrixXd::Zero(effect.cols(), effect.cols());
  out.gram.selfadjointView<Eigen::Lower>().rankUpdate(effect.transpose());
  out.gram.triangularView<Eigen::StrictlyUpper>() = out.gram.transpose();
  out.extremes = extremes_of(log, base, lanes, set, rate_);
  if (log.scenario.ports == Ports::actuator) out.piston = signal(base, Signal::piston_position);
  out.ok = out.gram.allFinite();
  return out;
}

std::vector<TestRun> TestBench::play(std::span<const std::vector<double>> waves, const LaneSet& set) {
  SimulateOptions options;
  options.threads = threads_;
  options.wanted.fill(false);
  for (const FitChannel& c : pattern_.channels) options.wanted[static_cast<std::size_t>(c.simulated)] = true;
  if (pattern_.scenario.ports == Ports::actuator)
    for (const Signal s : {Signal::piston_position, Signal::pressure_a, Signal::pressure_b})
      options.wanted[static_cast<std::size_t>(simulated_index(s))] = true;
  const std::size_t n = set.lanes.size() + 1;
  std::vector<TestRun> out(waves.size());
  for (std::size_t first = 0; first < waves.size(); first += k::batch) {
    const std::size_t count = std::min<std::size_t>(k::batch, waves.size() - first);
    std::vector<LogData> logs;
    for (std::size_t i = 0; i < count; ++i) logs.push_back(log_of(waves[first + i]));
    std::vector<Trajectory> runs(count * n);
    std::vector<Job> jobs;
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = 0; j < n; ++j)
        jobs.push_back({&logs[i].scenario, j == 0 ? &set.base : &set.lanes[j - 1].candidate, &runs[i * n + j]});
    simulate(jobs, options);
    simulations_ += static_cast<long>(jobs.size());
    failed_ += std::count_if(runs.begin(), runs.end(), [](const Trajectory& t) { return !t.ok; });
    const int threads = threads_ > 0 ? threads_ : omp_get_max_threads();
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
    for (std::size_t i = 0; i < count; ++i)
      out[first + i] = measure(std::move(logs[i]), runs[i * n], std::span(runs).subspan(i * n + 1, n - 1), set);
  }
  return out;
}

}  // namespace servodx
