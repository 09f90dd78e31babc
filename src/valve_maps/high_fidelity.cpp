#include "valve_maps/high_fidelity.h"

#include <cmath>
#include <numbers>

namespace servodx::valve_maps {
namespace {

constexpr double atmosphere = 101325.0;  // [Pa]

// Root of a function that falls with x, bracketed by growing steps about `x`, then halved to the last bit that matters.
template <class F>
double falling_root(const F& f, double x, double step) {
  double low = x, high = x;
  if (f(x) > 0)
    while (f(high = low + step) > 0) low = high, step *= 2;
  else
    while (f(low = high - step) < 0) high = low, step *= 2;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (f(middle) > 0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

HighFidelity::HighFidelity(const ValveGeometry& geometry)
    : g_(geometry), a_{geometry.lap_pa, geometry.lap_at}, b_{geometry.lap_pb, geometry.lap_bt} {}

double HighFidelity::passage(double opening, double dp) const {
  const double open = 0.5 * (opening + std::hypot(opening, g_.corner_radius)), covered = open - opening;
  const double c = g_.radial_clearance, gap2 = open * open + c * c, gap = std::sqrt(gap2);
  const double eccentric = 1.0 + 1.5 * g_.eccentricity * g_.eccentricity;
  const double laminar = g_.dynamic_viscosity / g_.port_width *
                         (12.0 * covered / (c * c * c * eccentric) + 32.0 / (std::numbers::pi * gap2));
  const double discharge =
      g_.discharge + (g_.discharge_round - g_.discharge) * g_.corner_radius / (g_.corner_radius + gap);
  const double area = discharge * g_.port_width * gap;
  const double turbulent = 0.5 * g_.density / (area * area);
  return 2.0 * dp / (laminar + std::sqrt(laminar * laminar + 4.0 * turbulent * std::fabs(dp)));
}

double HighFidelity::port_pressure(const Side& side, double x, double q, double supply) const {
  const double p = falling_root(
      [&](double above) {
        return passage(x - side.lap_supply, supply - above) - passage(-x - side.lap_return, above) - q;
      },
      0.5 * supply, 0.5 * supply);
  return std::fmax(p, g_.vapour_pressure - atmosphere - g_.return_pressure);
}

double HighFidelity::operator()(double x_s, double q_j, double supply) const {
  const double x = x_s + null_;
  return port_pressure(a_, x, q_j, supply) - port_pressure(b_, -x, -q_j, supply);
}

double HighFidelity::no_load_flow(double x_s, double supply) const {
  // Both ports at one pressure: what enters at one leaves at the other, so their flows add up to nothing.
  const double x = x_s + null_;
  const auto out_of_a = [&](double p) {
    return passage(x - a_.lap_supply, supply - p) - passage(-x - a_.lap_return, p);
  };
  const auto out_of_b = [&](double p) {
    return passage(-x - b_.lap_supply, supply - p) - passage(x - b_.lap_return, p);
  };
  const double p = falling_root([&](double at) { return out_of_a(at) + out_of_b(at); }, 0.5 * supply, 0.5 * supply);
  return 0.5 * (out_of_a(p) - out_of_b(p));
}

double HighFidelity::leakage(double x_s, double supply) const {
  const double x = x_s + null_;
  return passage(-x - a_.lap_return, port_pressure(a_, x, 0.0, supply)) +
         passage(x - b_.lap_return, port_pressure(b_, -x, 0.0, supply));
}

ValveNumbers HighFidelity::measure(double supply) {
  const double scale = g_.radial_clearance;
  const auto travel_at = [&](double load_pressure) {
    return falling_root([&](double x) { return load_pressure - (*this)(x, 0.0, supply); }, 0.0, scale);
  };
  null_ += travel_at(0.0);
  ValveNumbers v;
  v.supply = supply;
  v.null_slope = 0.8 * supply / (travel_at(0.4 * supply) - travel_at(-0.4 * supply));
  // The straight part of the no-load curve: beyond the null region on both sides.
  const double near = 10.0 * v.straight_travel(), far = 2.0 * near;
  const auto both = [&](double x) { return 0.5 * (no_load_flow(x, supply) - no_load_flow(-x, supply)); };
  v.flow_gain = (both(far) - both(near)) / (far - near);
  v.lap = near - both(near) / v.flow_gain;
  v.null_leakage = leakage(0.0, supply);
  v.quarter_leakage = leakage(0.0, 0.25 * supply);
  v.leakage = v.null_leakage / supply;
  v.meet_slope();
  v.vapour_pressure = g_.vapour_pressure;
  v.return_pressure = g_.return_pressure + atmosphere;
  return v;
}

}  // namespace servodx::valve_maps
