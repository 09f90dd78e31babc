#include "simulate/balance.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "effects/registry.h"
#include "model/derivative.h"
#include "signals/smoother.h"

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

double median_step(const std::vector<double>& time) {
  std::vector<double> d;
  for (std::size_t k = 1; k < time.size(); ++k) d.push_back(time[k] - time[k - 1]);
  const auto middle = d.begin() + static_cast<long>(d.size() / 2);
  std::nth_element(d.begin(), middle, d.end());
  return *middle;
}
constexpr double cushion = 0.05;  // of the stroke
constexpr double late = 1.5;      // median steps from one sample to the next: some are missing between them

}  // namespace

// Stretch by stretch: what happened in a gap is not known, and a line across it would put corners at its ends.
std::vector<double> quiet(const std::vector<double>& time, const std::vector<double>& measured) {
  std::vector<double> out = measured;
  if (time.size() < 3) return out;
  const double step = median_step(time);
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

template <class Effects>
Balance balance_with(const Scenario& in, const Measured& measured, const ParameterVector& p, double window) {
  Balance out;
  const std::size_t n = in.time.size();
  if (!measured.piston || !measured.pressure_a || !measured.pressure_b || n < 8 || in.ports != Ports::actuator)
    return out;
  // What a sensor stands for: less its offset, then its lag and gain undone. `shown`: of SensorResponse.
  const auto less = [&](const std::vector<double>& x, int offset, int shown) {
    std::vector<double> v = bridged(x);
    for (double& value : v) value -= p[static_cast<std::size_t>(offset)];
    const auto at = static_cast<std::size_t>(effect_row<SensorResponse>(2 * shown));
    const double gain = p[at], lag = p[at + 1];
    if (gain == 1 && lag == 0) return v;
    std::vector<double> truth(n);
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t from = k > 0 ? k - 1 : 0, to = std::min(k + 1, n - 1);
      truth[k] = (v[k] + lag * (v[to] - v[from]) / (in.time[to] - in.time[from])) / gain;
    }
    return truth;
  };
  // Taking noise out is linear and leaves a constant alone: what the sensor does can be undone behind it.
  std::vector<double> smooth = bridged(measured.quiet ? *measured.piston : quiet(in.time, *measured.piston));
  for (double& v : smooth) v /= p[row::position_sensor_gain];
  const std::vector<double> a = less(*measured.pressure_a, nuisance::pressure_a_offset, 1),
                            b = less(*measured.pressure_b, nuisance::pressure_b_offset, 2);
  std::vector<double> spool;
  if (measured.spool)
    spool = less(measured.quiet ? *measured.spool : quiet(in.time, *measured.spool), nuisance::spool_offset, 0);
  const Derived<double> d = derive<double, Effects>(p.data(), in.oil);
  const auto input = [&](const std::vector<double>& series, std::size_t k, double table) {
    return series.empty() ? table : series[k];
  };

  // Net flows over compliance and net force over mass at every sample, the rod at rest for the flows.
  std::vector<double> rate_a(n), rate_b(n), force(n), compliance_a(n), compliance_b(n);
  std::vector<double> supply = in.supply_pressure;
  const double mean_supply = std::accumulate(supply.begin(), supply.end(), 0.0) / static_cast<double>(n);
  const double droop = p[effect_row<SupplyDroop>(0)] * 0.5 * (p[row::piston_area_a] + p[row::piston_area_b]);
  SampledLag<double> drawn;
  FrictionMemory<double> friction;
  friction.rest(0.0, smooth[0]);
  for (std::size_t k = 0; k < n; ++k) {
    const double dt = in.time[std::min(k + 1, n - 1)] - in.time[k > 0 ? k - 1 : 0];
    States<Effects> s;
    s.y[s_p_a] = a[k], s.y[s_p_b] = b[k];
    s.y[s_x_spool] = spool.empty() ? 0.0 : spool[k];
    s.y[s_x_piston] = smooth[k];
    s.y[s_v_piston] = (smooth[std::min(k + 1, n - 1)] - smooth[k > 0 ? k - 1 : 0]) / dt;
    if (!supply.empty())
      supply[k] += droop * drawn(in.time[k], std::abs(s.y[s_v_piston]), p[effect_row<SupplyDroop>(1)]) - mean_supply;
    s.y[s_p_filter] = s.y[s_p_pilot_1] = s.y[s_p_pilot_2] = 0.5 * p[row::supply_pressure];
    if (k > 0) friction.move(0.0, 0.0, smooth[k - 1], smooth[k], in.time[k] - in.time[k - 1], d.breakaway);
    const Inputs<double> u{0.0, input(in.supply_pressure, k, p[row::supply_pressure]),
                           input(in.return_pressure, k, p[row::return_pressure]), input(in.load_force, k, 0.0),
                           friction};
    const auto f = derivative<Effects, double>(s, u, p.data(), d);
    force[k] = p[row::moving_mass] * std::get<s_v_piston>(f);
    compliance_a[k] = 1.0 / chamber_stiffness(d.middle_volume_a + p[row::piston_area_a] * smooth[k], a[k], d, p.data());
    compliance_b[k] = 1.0 / chamber_stiffness(d.middle_volume_b - p[row::piston_area_b] * smooth[k], b[k], d, p.data());
    rate_a[k] = std::get<s_p_a>(f) * compliance_a[k] + p[row::piston_area_a] * s.y[s_v_piston];
    rate_b[k] = std::get<s_p_b>(f) * compliance_b[k] - p[row::piston_area_b] * s.y[s_v_piston];
  }

  const double step = median_step(in.time);
  const auto half = std::max<std::size_t>(2, static_cast<std::size_t>(std::lround(0.5 * window / step)));
  const double reach = *std::max_element(std::begin(constants::seal_presliding), std::end(constants::seal_presliding));
  const double free_travel = (0.5 - cushion) * p[row::piston_stroke];
  for (std::size_t mid = half; mid + half < n; mid += half) {
    const std::size_t from = mid - half, to = mid + half;
    const double span = in.time[to] - in.time[from], side = 0.5 * span;
    bool whole = true;  // no sample is missing
    for (std::size_t k = from; k <= to; ++k) {
      whole = whole && (k == to || in.time[k + 1] - in.time[k] <= late * step);
      for (const auto* x : {measured.piston, measured.pressure_a, measured.pressure_b, measured.spool})
        whole = whole && (!x || std::isfinite((*x)[k]));
    }
    if (!whole) continue;
    // Trapezoid rule for the flows, a hat for the force.
    double q_a = 0, q_b = 0, net = 0, hat = 0, above = 0;
    for (std::size_t k = from; k <= to; ++k) {
      const double edge = k == from || k == to ? 0.5 : 1.0;
      q_a += edge * rate_a[k], q_b += edge * rate_b[k];
      if (!supply.empty()) above += edge * supply[k];
      const double w = 1.0 - std::abs(in.time[k] - in.time[mid]) / side;
      net += w * force[k], hat += w;
    }
    const auto samples = static_cast<double>(to - from);
    out.time.push_back(in.time[mid]);
    const double v = (smooth[to] - smooth[from]) / span;
    out.piston.push_back(smooth[mid]), out.velocity.push_back(v), out.load_pressure.push_back(a[mid] - b[mid]);
    bool slides = std::abs(smooth[mid]) < free_travel;
    for (int quarter = 0; quarter < 4; ++quarter) {
      const std::size_t start = from + (to - from) * quarter / 4, end = from + (to - from) * (quarter + 1) / 4;
      slides = slides && 4 * (smooth[end] - smooth[start]) * (v < 0 ? -1 : 1) > reach;
    }
    out.slides.push_back(slides);
    out.force.push_back(p[row::moving_mass] * (smooth[to] - 2 * smooth[mid] + smooth[from]) / (side * side) -
                        net / hat);
    if (!supply.empty()) out.supply.push_back(above / samples);
    if (spool.empty()) continue;
    out.spool.push_back(spool[mid]);
    out.flow_a.push_back(compliance_a[mid] * (a[to] - a[from]) / span - q_a / samples + p[row::piston_area_a] * v);
    out.flow_b.push_back(compliance_b[mid] * (b[to] - b[from]) / span - q_b / samples - p[row::piston_area_b] * v);
  }
  return out;
}

}  // namespace

// A learnt curve is worked out only where there is one.
Balance balance(const Scenario& in, const Measured& measured, const ParameterVector& p, double window) {
  bool curve = false;
  for (int k = 0; k < Unexplained::knots; ++k)
    curve = curve || p[static_cast<std::size_t>(effect_row<Unexplained>(4 + k))] != 0;
  return curve ? balance_with<CorrectedEffects>(in, measured, p, window)
               : balance_with<AllEffects>(in, measured, p, window);
}

}  // namespace servodx
