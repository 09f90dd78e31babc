#include "explain/missing.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/two_pi.h"
#include "effects/unexplained.h"
#include "explain/constants.h"
#include "explain/linear_run.h"
#include "explain/smoother.h"
#include "fit/log_data.h"
#include "fit/log_start.h"
#include "fit/problem.h"
#include "optimise/unit_cube.h"
#include "parameters/list.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "simulate/linearise.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

namespace k = explain_constants;

// What a channel shows of the model's states; empty: of none that the smoother knows.
Eigen::VectorXd shown(Signal signal, int states, const ParameterVector& p) {
  Eigen::VectorXd h = Eigen::VectorXd::Zero(states);
  switch (signal) {
    case Signal::spool_position:
      h[s_x_spool] = 1;
      return h;
    case Signal::piston_position:
      h[s_x_piston] = p[row::position_sensor_gain];
      h[s_v_piston] = -p[row::position_sensor_gain] * p[row::position_sensor_lag];
      return h;
    case Signal::pressure_a:
      h[s_p_a] = 1;
      return h;
    case Signal::pressure_b:
      h[s_p_b] = 1;
      return h;
    case Signal::pilot_pressure_1:
      h[s_p_pilot_1] = 1;
      return h;
    case Signal::pilot_pressure_2:
      h[s_p_pilot_2] = 1;
      return h;
    case Signal::load_pressure:
      h[s_p_a] = 1, h[s_p_b] = -1;
      return h;
    default:
      return {};
  }
}

template <class X>
std::vector<X> every(const std::vector<X>& x, int stride) {
  std::vector<X> out;
  for (std::size_t k = 0; k < x.size(); k += static_cast<std::size_t>(stride)) out.push_back(x[k]);
  return out;
}

// A channel behind a high-pass, which is one more state.
struct Filtered {
  Eigen::VectorXd shows;  // of the model's states, ahead of the filter
  double corner;          // [Hz]
  double noise;           // [SI]
};

// How far the start of a run may be from where it is said to be: as far as the sensors' noise, and wide where nothing
// is measured.
struct StartNoise {
  double piston, spool, pressure;  // [m], [m], [Pa]
};
StartNoise start_noise_of(const std::vector<FitChannel>& channels, const ParameterVector& p) {
  StartNoise out{0, k::start_of_spool * p[row::spool_stop], k::start_of_pressure * p[row::supply_pressure]};
  for (const FitChannel& channel : channels) {
    if (channel.signal == Signal::piston_position) out.piston = channel.noise;
    if (channel.signal == Signal::spool_position) out.spool = channel.noise;
    if (channel.signal == Signal::pressure_a) out.pressure = channel.noise;
  }
  return out;
}

// [states] of the model and of the filters behind them.
Eigen::VectorXd start_of(const Linearisation& linear, const StartNoise& noise, const std::vector<Filtered>& filtered,
                         const std::vector<double>& time) {
  const long own = linear.states - n_missing_places, extra = static_cast<long>(filtered.size());
  Eigen::VectorXd out = Eigen::VectorXd::Zero(own + extra);
  out.head(own) = linear.at_rest.head(own);
  out[s_x_spool] = noise.spool;
  out[s_p_a] = out[s_p_b] = noise.pressure;
  out[s_x_piston] = noise.piston;
  out[s_v_piston] = noise.piston * starting_slope_error(time);
  for (long f = 0; f < extra; ++f) out[own + f] = k::start_of_filter * filtered[static_cast<std::size_t>(f)].noise;
  return out;
}

// The model's step over dt [s], and that of the filters behind it. As signals/filters.h has it: y' = x' - rate y, x a
// line between the samples.
Eigen::MatrixXd step_with_filters(const Eigen::MatrixXd& from, const std::vector<Filtered>& filtered, double dt) {
  const long own = from.rows() - n_missing_places, extra = static_cast<long>(filtered.size()), all = own + extra;
  Eigen::MatrixXd to = Eigen::MatrixXd::Zero(all, all + n_missing_places);
  to.topLeftCorner(own, own) = from.topLeftCorner(own, own);
  to.topRightCorner(own, n_missing_places) = from.topRightCorner(own, n_missing_places);
  for (long f = 0; f < extra; ++f) {
    const Filtered& by = filtered[static_cast<std::size_t>(f)];
    const double z = two_pi * by.corner * dt, passes = -std::expm1(-z) / z;
    to.row(own + f).head(own) = passes * (by.shows.transpose() * from.topLeftCorner(own, own) - by.shows.transpose());
    to.row(own + f).tail(n_missing_places) = passes * by.shows.transpose() * from.topRightCorner(own, n_missing_places);
    to(own + f, own + f) = std::exp(-z);
  }
  return to;
}

// A channel's residual and what is known of its noise: as healthy logs have it, or the sensor's.
LinearChannel weighed_channel(const ValveSubject& subject, std::size_t series, const std::vector<double>& residual,
                              double noise, int stride) {
  LinearChannel out;
  out.residual = every(residual, stride);
  if (!subject.holds()) {
    out.sigma.assign(out.residual.size(), noise);
    return out;
  }
  out.sigma = every(*subject.series()[series].sigma, stride);
  const double a = subject.memory(series);
  out.memory = std::pow(a, stride);
  for (double& s : out.sigma) s *= std::sqrt((1 - out.memory * out.memory) / (1 - a * a));
  return out;
}

// One log as the smoother takes it. `series`: of its first channel.
LinearRun linear_run(const ValveSubject& subject, const FitProblem& problem, const Trajectory& run, int log,
                     std::size_t series, const ParameterVector& p, int stride) {
  const LogData& data = subject.logs()[static_cast<std::size_t>(log)];
  Linearisation linear = linearise(data.scenario, p, {}, stride);
  if (!linear.ok) return {};
  LinearRun out;
  out.time = every(data.scenario.time, stride);
  const long own = linear.states - n_missing_places;
  std::vector<Filtered> filtered;
  for (std::size_t c = 0; c < data.channels.size(); ++c) {
    const FitChannel& channel = data.channels[c];
    Eigen::VectorXd shows = shown(channel.signal, static_cast<int>(own), p);
    if (shows.size() == 0) continue;
    const std::vector<double> residual = problem.raw_residual(log, static_cast<int>(c), run);
    LinearChannel& to =
        out.channels.emplace_back(weighed_channel(subject, series + c, residual, channel.noise, stride));
    if (channel.filter.drift > 0) {
      filtered.push_back({std::move(shows), channel.filter.drift, channel.noise});
      shows =
          Eigen::VectorXd::Unit(own + static_cast<long>(filtered.size()), own + static_cast<long>(filtered.size()) - 1);
    }
    to.shows = std::move(shows);
  }
  for (LinearChannel& c : out.channels) {
    const long had = c.shows.size(), all = own + static_cast<long>(filtered.size());
    c.shows.conservativeResize(all);
    c.shows.tail(all - had).setZero();
  }
  out.start = start_of(linear, start_noise_of(data.channels, p), filtered, data.scenario.time);
  for (std::size_t k = 0; k < linear.transition.size(); ++k) {
    const Eigen::MatrixXd from = std::move(linear.transition[k]);
    out.transition.push_back(step_with_filters(from, filtered, out.time[k + 1] - out.time[k]));
  }
  return out;
}

// Signals that what is missing may depend on, as simulated.
std::vector<std::pair<std::string, std::vector<double>>> variables_of(const Scenario& in, const Trajectory& t,
                                                                      int stride) {
  const auto signal = [&](Signal s) -> const std::vector<double>& {
    return t.signals[static_cast<std::size_t>(simulated_index(s))];
  };
  const auto& spool = signal(Signal::spool_position);
  const auto& piston = signal(Signal::piston_position);
  const auto rate = [&](const std::vector<double>& x) {
    std::vector<double> v(x.size(), 0.0);
    for (std::size_t k = 1; k < x.size(); ++k) v[k] = (x[k] - x[k - 1]) / (in.time[k] - in.time[k - 1]);
    return v;
  };
  // Rounded as a learnt curve's: at rest there is none.
  const auto direction = [](std::vector<double> v) {
    for (double& x : v) x = x / std::hypot(x, Unexplained::direction_speed);
    return v;
  };
  std::vector<double> load;
  for (std::size_t k = 0; k < in.time.size(); ++k)
    load.push_back(signal(Signal::pressure_a)[k] - signal(Signal::pressure_b)[k]);
  std::vector<std::pair<std::string, std::vector<double>>> out = {{"coil_current", in.command},
                                                                  {"spool_position", spool},
                                                                  {"spool_velocity", rate(spool)},
                                                                  {"direction of the spool", direction(rate(spool))},
                                                                  {"piston_position", piston},
                                                                  {"piston_velocity", rate(piston)},
                                                                  {"direction of the piston", direction(rate(piston))},
                                                                  {"load_pressure", load}};
  for (auto& [name, values] : out) values = every(values, stride);
  return out;
}

// Share of the square of y about its mean that a line in x takes, each sample weighed by how well it is known.
struct LineShare {
  double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
  void add(double vx, double vy, double w) {
    n += w, x += w * vx, y += w * vy, xx += w * vx * vx, yy += w * vy * vy, xy += w * vx * vy;
  }
  double value() const {
    const double vx = xx - x * x / n, vy = yy - y * y / n, c = xy - x * y / n;
    return vx > 0 && vy > 0 ? c * c / (vx * vy) : 0;
  }
};

// The logs' linear runs, thinned to so many samples as are looked at, and what the missing inputs may follow.
struct LinearLogs {
  std::vector<LinearRun> runs;
  std::vector<std::vector<std::pair<std::string, std::vector<double>>>> variables;  // [log]
};

// None where a log has no block to look at. `time` takes those of the logs that have.
std::optional<LinearLogs> linear_logs(const ValveSubject& subject, const Point& point,
                                      std::vector<std::vector<double>>& time) {
  const auto problem = subject.problem({});
  std::size_t samples = 0, series = 0;
  for (const LogData& l : subject.logs()) samples += l.scenario.time.size();
  const auto stride = static_cast<int>(samples / k::most_samples) + 1;
  // The steps of a fit are too coarse for what is looked at sample by sample; for its derivatives they do.
  SimulateOptions fine = fine_steps();
  fine.wanted.fill(true);
  LinearLogs out;
  for (std::size_t l = 0; l < subject.logs().size(); ++l) {
    const LogData& log = subject.logs()[l];
    if (log.scenario.ports != Ports::actuator) return {};
    const ParameterVector p = problem->candidate(point, static_cast<int>(l));
    const Trajectory run = simulate(log.scenario, p, fine);
    if (!run.ok) return {};
    out.runs.push_back(linear_run(subject, *problem, run, static_cast<int>(l), series, p, stride));
    if (out.runs.back().channels.empty()) return {};
    series += log.channels.size();
    out.variables.push_back(variables_of(log.scenario, run, stride));
    time.push_back(out.runs.back().time);
  }
  return out;
}

// What a place misses, how large it is over the logs, and the variable that it follows most closely.
MissingInput described_input(const SmoothedInput& from, const MissingPlace& place, double cost,
                             const LinearLogs& logs) {
  MissingInput to{place.where, place.quantity, place.unit};
  to.gain = from.gain - cost;
  to.value = from.value, to.error = from.std_error;
  double n = 0, square = 0, error = 0;
  for (std::size_t l = 0; l < to.value.size(); ++l)
    for (std::size_t k = 0; k < to.value[l].size(); ++k)
      n += 1, square += std::pow(to.value[l][k], 2), error += std::pow(to.error[l][k], 2);
  to.rms = std::sqrt(square / n), to.std_error = std::sqrt(error / n);
  for (std::size_t v = 0; v < logs.variables.front().size(); ++v) {
    LineShare line;
    for (std::size_t l = 0; l < to.value.size(); ++l)
      for (std::size_t k = 0; k < to.value[l].size(); ++k) {
        const double e = to.error[l][k], w = 1 / (e * e + to.std_error * to.std_error);
        if (std::isfinite(w)) line.add(logs.variables[l][v].second[k], to.value[l][k], w);
      }
    if (const double share = line.value(); share > to.share)
      to.share = share, to.variable = logs.variables.front()[v].first;
  }
  return to;
}

void mark_likely(const std::vector<SmoothedInput>& smoothed, std::vector<MissingInput>& places) {
  const auto best =
      std::max_element(smoothed.begin(), smoothed.end(), [](const auto& a, const auto& b) { return a.gain < b.gain; });
  for (std::size_t i = 0; i < places.size(); ++i)
    places[i].likely = places[i].gain > std::log(k::odds_of_a_place) && !preferred(*best, smoothed[i]);
}

}  // namespace

MissingInputs missing_inputs(const ValveSubject& subject, const Point& point, const std::function<bool(double)>& told) {
  MissingInputs out;
  const std::optional<LinearLogs> logs = linear_logs(subject, point, out.time);
  if (!logs) return out;
  std::vector<double> typical;
  for (const MissingPlace& place : missing_places) typical.push_back(place.typical);
  const SmootherResult smoothed = smooth(logs->runs, typical, told);
  const double cost = 0.5 * std::log(std::max(2.0, smoothed.independent));
  for (std::size_t i = 0; i < smoothed.places.size(); ++i)
    out.places.push_back(described_input(smoothed.places[i], missing_places[i], cost, *logs));
  mark_likely(smoothed.places, out.places);
  std::stable_sort(out.places.begin(), out.places.end(), [](const auto& a, const auto& b) { return a.gain > b.gain; });
  return out;
}

}  // namespace servodx
