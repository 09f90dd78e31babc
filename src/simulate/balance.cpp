#include "simulate/balance.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "effects/line_inertia.h"
#include "effects/registry.h"
#include "effects/sampled_lag.h"
#include "effects/sensor_response.h"
#include "effects/supply_droop.h"
#include "effects/unexplained.h"
#include "model/asperities.h"
#include "model/chamber.h"
#include "model/constants.h"
#include "model/derivative.h"
#include "model/derived.h"
#include "model/state.h"
#include "parameters/list.h"
#include "servodx/rig.h"
#include "signals/usual_step.h"
#include "signals/without_noise.h"

namespace servodx {
namespace {

template <class Effects>
struct States {
  std::array<double, n_base_states + Effects::n_states> y{};
  template <int K>
  double get() const {
    return y[K];
  }
};

std::vector<double> bridged(const std::vector<double>& x) {
  std::vector<double> out = x;
  double last = 0;
  for (double v : x)
    if (std::isfinite(v)) {
      last = v;
      break;
    }
  for (double& v : out) v = std::isfinite(v) ? last = v : last;
  return out;
}

}  // namespace

namespace {

constexpr double cushion = 0.05;  // of the stroke
constexpr double late = 1.5;      // median steps from one sample to the next: some are missing between them

}  // namespace

// Stretch by stretch: what happened in a gap is not known, and a line across it would put corners at its ends.
std::vector<double> quiet(const std::vector<double>& time, const std::vector<double>& measured) {
  std::vector<double> out = measured;
  if (time.size() < 3) return out;
  const double step = usual_step(time);
  for (std::size_t from = 0, to; from < out.size(); from = std::max(to, from + 1)) {
    to = from;
    while (to < out.size() && std::isfinite(measured[to]) && (to == from || time[to] - time[to - 1] <= late * step))
      ++to;
    const std::vector<double> smooth = without_noise(std::span(measured).subspan(from, to - from));
    std::copy(smooth.begin(), smooth.end(), out.begin() + static_cast<long>(from));
  }
  return out;
}

namespace {

// What the sensors stand for: noise out, offset, lag and gain undone. [SI] a sample each; spool empty: not logged.
struct TrueSignals {
  std::vector<double> piston, pressure_a, pressure_b, spool;
};

// Less its offset, then its lag and gain undone. `sensor`: of SensorResponse.
std::vector<double> undone(const Scenario& in, const ParameterVector& p, const std::vector<double>& shown, int offset,
                           int sensor) {
  std::vector<double> v = bridged(shown);
  for (double& value : v) value -= p[static_cast<std::size_t>(offset)];
  const auto at = static_cast<std::size_t>(effect_row<SensorResponse>(2 * sensor));
  const double gain = p[at], lag = p[at + 1];
  if (gain == 1 && lag == 0) return v;
  const std::size_t n = v.size();
  std::vector<double> truth(n);
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t from = k > 0 ? k - 1 : 0, to = std::min(k + 1, n - 1);
    truth[k] = (v[k] + lag * (v[to] - v[from]) / (in.time[to] - in.time[from])) / gain;
  }
  return truth;
}

// Taking noise out is linear and leaves a constant alone: what the sensor does can be undone behind it.
TrueSignals true_signals(const Scenario& in, const Measured& measured, const ParameterVector& p) {
  TrueSignals s;
  s.piston = bridged(measured.quiet ? *measured.piston : quiet(in.time, *measured.piston));
  for (double& v : s.piston) v /= p[row::position_sensor_gain];
  s.pressure_a = undone(in, p, *measured.pressure_a, nuisance::pressure_a_offset, 1);
  s.pressure_b = undone(in, p, *measured.pressure_b, nuisance::pressure_b_offset, 2);
  if (measured.spool)
    s.spool =
        undone(in, p, measured.quiet ? *measured.spool : quiet(in.time, *measured.spool), nuisance::spool_offset, 0);
  return s;
}

// Net flows over compliance and net force over mass at every sample, the rod at rest for the flows.
struct Rates {
  std::vector<double> flow_a, flow_b;              // [m3/s] that the edges and the seal let in
  std::vector<double> force;                       // [N]
  std::vector<double> compliance_a, compliance_b;  // [m3/Pa]
  std::vector<double> supply;                      // [Pa] above its mean and the droop; empty: not measured

  explicit Rates(std::size_t n) : flow_a(n), flow_b(n), force(n), compliance_a(n), compliance_b(n) {}
};

template <class Effects>
Rates rates_along(const Scenario& in, const TrueSignals& of, const ParameterVector& p) {
  const std::size_t n = in.time.size();
  Rates out(n);
  out.supply = in.supply_pressure;
  const Derived<double> d = derive<double, Effects>(p.data(), in.oil);
  const auto input = [&](const std::vector<double>& series, std::size_t k, double table) {
    return series.empty() ? table : series[k];
  };
  const double mean_supply = std::accumulate(out.supply.begin(), out.supply.end(), 0.0) / static_cast<double>(n);
  const double droop = p[effect_row<SupplyDroop>(0)] * 0.5 * (p[row::piston_area_a] + p[row::piston_area_b]);
  SampledLag<double> drawn;
  FrictionMemory<double> friction;
  friction.rest(0.0, of.piston[0]);
  for (std::size_t k = 0; k < n; ++k) {
    const double dt = in.time[std::min(k + 1, n - 1)] - in.time[k > 0 ? k - 1 : 0];
    States<Effects> s;
    s.y[s_p_a] = of.pressure_a[k], s.y[s_p_b] = of.pressure_b[k];
    s.y[s_x_spool] = of.spool.empty() ? 0.0 : of.spool[k];
    s.y[s_x_piston] = of.piston[k];
    s.y[s_v_piston] = (of.piston[std::min(k + 1, n - 1)] - of.piston[k > 0 ? k - 1 : 0]) / dt;
    if (!out.supply.empty())
      out.supply[k] +=
          droop * drawn(in.time[k], std::abs(s.y[s_v_piston]), p[effect_row<SupplyDroop>(1)]) - mean_supply;
    s.y[s_p_filter] = s.y[s_p_pilot_1] = s.y[s_p_pilot_2] = 0.5 * p[row::supply_pressure];
    if (k > 0)
      friction.move(0.0, 0.0, of.piston[k - 1], of.piston[k], in.time[k] - in.time[k - 1], d.spool_presliding,
                    d.breakaway);
    const Inputs<double> u{0.0, input(in.supply_pressure, k, p[row::supply_pressure]),
                           input(in.return_pressure, k, p[row::return_pressure]), input(in.load_force, k, 0.0),
                           friction};
    const auto f = derivative<Effects, double>(s, u, p.data(), d);
    out.force[k] = p[row::moving_mass] * std::get<s_v_piston>(f);
    out.compliance_a[k] = 1.0 / chamber_stiffness<Effects>(d.middle_volume_a + p[row::piston_area_a] * of.piston[k],
                                                           p[row::hose_compliance], of.pressure_a[k], d);
    out.compliance_b[k] = 1.0 / chamber_stiffness<Effects>(d.middle_volume_b - p[row::piston_area_b] * of.piston[k],
                                                           p[row::hose_compliance], of.pressure_b[k], d);
    out.flow_a[k] = std::get<s_p_a>(f) * out.compliance_a[k] + p[row::piston_area_a] * s.y[s_v_piston];
    out.flow_b[k] = std::get<s_p_b>(f) * out.compliance_b[k] - p[row::piston_area_b] * s.y[s_v_piston];
  }
  return out;
}

// Samples [from, to] of one window, `mid` its middle.
struct Window {
  std::size_t from, mid, to;
};

// No sample of the window is missing.
bool is_whole(const Window& w, const Scenario& in, const Measured& measured, double step) {
  bool whole = true;
  for (std::size_t k = w.from; k <= w.to; ++k) {
    whole = whole && (k == w.to || in.time[k + 1] - in.time[k] <= late * step);
    for (const auto* x : {measured.piston, measured.pressure_a, measured.pressure_b, measured.spool})
      whole = whole && (!x || std::isfinite((*x)[k]));
  }
  return whole;
}

// The rod slides all through the window, one way and clear of the cushions (Balance::slides).
bool slides_through(const Window& w, const std::vector<double>& piston, double velocity, const ParameterVector& p) {
  const double reach = *std::max_element(std::begin(constants::seal_presliding), std::end(constants::seal_presliding));
  const double free_travel = (0.5 - cushion) * p[row::piston_stroke];
  bool slides = std::abs(piston[w.mid]) < free_travel;
  for (int quarter = 0; quarter < 4; ++quarter) {
    const std::size_t start = w.from + (w.to - w.from) * quarter / 4,
                      end = w.from + (w.to - w.from) * (quarter + 1) / 4;
    slides = slides && 4 * (piston[end] - piston[start]) * (velocity < 0 ? -1 : 1) > reach;
  }
  return slides;
}

// Trapezoid rule for the flows, a hat for the force.
void balance_window(Balance& out, const Window& w, const Scenario& in, const TrueSignals& of, const Rates& rates,
                    const ParameterVector& p) {
  const double span = in.time[w.to] - in.time[w.from], side = 0.5 * span;
  double q_a = 0, q_b = 0, net = 0, hat = 0, above = 0;
  for (std::size_t k = w.from; k <= w.to; ++k) {
    const double edge = k == w.from || k == w.to ? 0.5 : 1.0;
    q_a += edge * rates.flow_a[k], q_b += edge * rates.flow_b[k];
    if (!rates.supply.empty()) above += edge * rates.supply[k];
    const double weight = 1.0 - std::abs(in.time[k] - in.time[w.mid]) / side;
    net += weight * rates.force[k], hat += weight;
  }
  const auto& [x, a, b, spool] = of;
  const auto samples = static_cast<double>(w.to - w.from);
  const double v = (x[w.to] - x[w.from]) / span;
  out.time.push_back(in.time[w.mid]);
  out.piston.push_back(x[w.mid]), out.velocity.push_back(v), out.load_pressure.push_back(a[w.mid] - b[w.mid]);
  out.slides.push_back(slides_through(w, x, v, p));
  out.force.push_back(p[row::moving_mass] * (x[w.to] - 2 * x[w.mid] + x[w.from]) / (side * side) - net / hat);
  if (!rates.supply.empty()) out.supply.push_back(above / samples);
  if (spool.empty()) return;
  out.spool.push_back(spool[w.mid]);
  out.flow_a.push_back(rates.compliance_a[w.mid] * (a[w.to] - a[w.from]) / span - q_a / samples +
                       p[row::piston_area_a] * v);
  out.flow_b.push_back(rates.compliance_b[w.mid] * (b[w.to] - b[w.from]) / span - q_b / samples -
                       p[row::piston_area_b] * v);
}

template <class Effects>
Balance balance_with(const Scenario& in, const Measured& measured, const ParameterVector& p, double window) {
  Balance out;
  const std::size_t n = in.time.size();
  if (!measured.piston || !measured.pressure_a || !measured.pressure_b || n < 8 || in.ports != Ports::actuator)
    return out;
  const TrueSignals signals = true_signals(in, measured, p);
  const Rates rates = rates_along<Effects>(in, signals, p);
  const double step = usual_step(in.time);
  const auto half = std::max<std::size_t>(2, static_cast<std::size_t>(std::lround(0.5 * window / step)));
  for (std::size_t mid = half; mid + half < n; mid += half)
    if (const Window w{mid - half, mid, mid + half}; is_whole(w, in, measured, step))
      balance_window(out, w, in, signals, rates, p);
  return out;
}

}  // namespace

// A learnt curve is worked out only where there is one.
Balance balance(const Scenario& in, const Measured& measured, const ParameterVector& p, double window) {
  bool curve = false;
  for (int k = 0; k < Unexplained::knots; ++k)
    curve = curve || p[static_cast<std::size_t>(effect_row<Unexplained>(4 + k))] != 0;
  if (!curve) return balance_with<AllEffects>(in, measured, p, window);
  ParameterVector at_taps = p;  // what stands behind the lines is not measured
  at_taps[static_cast<std::size_t>(effect_row<LineInertia>(0))] = 0;
  return balance_with<CorrectedEffects>(in, measured, at_taps, window);
}

}  // namespace servodx
