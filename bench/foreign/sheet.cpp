#include "sheet.h"

#include <cmath>
#include <complex>
#include <numbers>

#include "base/random.h"
#include "condition.h"
#include "machine.h"

namespace servodx::foreign {
namespace {
using std::numbers::pi;

constexpr double bar = 1e5;
constexpr double amplitude = 0.25;  // [1] of rated current, at which the lag is stated

struct Leakage {
  double pilot, whole;  // [m3/s]
};

// With the spool at its null.
Leakage leakage(const Design& d) {
  const Machine machine(d, Condition{});
  State s = machine.rest(), rates;
  const Drive still;
  for (long i = 0, n = std::lround(0.1 / d.step); i < n; ++i) machine.step(s, still, d.step);
  Flows flows;
  machine.rates(s, still, rates, flows);
  return {flows.screen, flows.screen + flows.edge[edge_pa] + flows.edge[edge_pb]};
}

// [rad] of the spool behind the demand in a sine, 0 to a turn.
double lag(const Design& d, double hertz) {
  const Machine machine(d, Condition{});
  State s = machine.rest();
  Drive in;
  std::complex<double> spool = 0.0, demand = 0.0;
  const long period = std::lround(1.0 / (hertz * d.step));
  for (long i = 0; i < 7 * period; ++i) {
    const double turn = 2 * pi * static_cast<double>(i) / static_cast<double>(period);
    in.demand = amplitude * d.rated_current * std::sin(turn);
    if (i >= 4 * period) {
      spool += std::polar(s[x_spool], -turn);
      demand += std::polar(1.0, -turn) * in.demand;
    }
    machine.step(s, in, d.step);
  }
  const double behind = -std::arg(spool / demand);
  // A little ahead is the magnetic loop's doing at slow tests, not most of a turn behind.
  return behind < -0.3 ? behind + 2 * pi : behind;
}

double lag_frequency(const Design& d) {
  double low = 0.3 * d.valve_bandwidth, high = 10.0 * d.valve_bandwidth;
  while (high > 1.03 * low) {
    const double middle = std::sqrt(low * high);
    (lag(d, middle) < pi / 2 ? low : high) = middle;
  }
  return low;
}

}  // namespace

Sheet draw_sheet(const Design& d) {
  Random random(d.seed, 4);
  const auto about = [&](double x, double part) { return x * random.uniform(1.0 - part, 1.0 + part); };
  const FirstStage& f = d.first;
  const Leakage leaks = leakage(d);
  Sheet s{};
  s.rated_flow = about(d.rated_flow, 0.05);
  s.stroke = about(d.spool.stroke, 0.03);
  s.stop = s.stroke * about(d.spool.stop / d.spool.stroke, 0.02);
  s.spool_diameter = about(d.spool.diameter, 0.01);
  s.clearance = about(d.spool.clearance, 0.25);
  s.nozzle = about(f.nozzle, 0.05);
  s.orifice = about(f.orifice, 0.05);
  s.gap = about(f.gap, 0.10);
  s.lag_frequency = about(lag_frequency(d), 0.15);
  s.pilot_leakage = about(leaks.pilot, 0.10);
  s.null_leakage = s.pilot_leakage + about(leaks.whole - leaks.pilot, 0.25);
  s.motor_frequency = about(d.motor_frequency, 0.08);
  s.area_a = about(d.actuator.area_a, 0.005);
  s.area_b = d.actuator.area_b == d.actuator.area_a ? s.area_a : about(d.actuator.area_b, 0.005);
  s.actuator_stroke = d.actuator.stroke;
  s.mass = about(d.actuator.mass, 0.08);
  s.mount = random.uniform() < 0.5 ? about(d.actuator.mount, 0.2) : 0.0;
  s.line_length = d.lines.length < 0.2 && random.uniform() < 0.5 ? 0.0 : about(d.lines.length, 0.1);
  s.line_bore = d.lines.bore;
  s.pressure = about(d.supply.pressure, 0.01);
  s.return_pressure = d.supply.tank + random.uniform() * bar;
  s.density = about(d.oil.density, 0.01);
  s.viscosity = about(d.oil.viscosity_40, 0.06);
  return s;
}

}  // namespace servodx::foreign
