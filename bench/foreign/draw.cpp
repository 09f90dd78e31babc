// Draws a design: the rated flow, the oil and the supply first, then sizes that follow from them with their spread.
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>

#include "base/random.h"
#include "design.h"
#include "oil.h"

namespace servodx::foreign {
namespace {
using std::numbers::pi;

constexpr double bar = 1e5, litre_per_minute = 1e-3 / 60.0;
constexpr double middle = 40.0 * litre_per_minute;  // the valve from which sizes are scaled

// Makers' typical values; the stiffness is isentropic, of oil without air.
constexpr OilKind oils[] = {
    {"MIL-PRF-5606", true, 870, 14.0e-6, 5.0e-6, 130, 1.35e9, -6.5e6, 10.5, 1.6e-8, 8.0e-4, 150 * bar},
    {"MIL-PRF-83282", true, 845, 14.5e-6, 3.5e-6, 120, 1.50e9, -7.0e6, 11.0, 1.5e-8, 7.8e-4, 180 * bar},
    {"ISO VG 32", false, 868, 32.0e-6, 5.4e-6, 95, 1.48e9, -7.0e6, 10.0, 2.0e-8, 7.0e-4, 220 * bar},
    {"ISO VG 46", false, 874, 46.0e-6, 6.8e-6, 95, 1.50e9, -7.0e6, 10.0, 2.1e-8, 7.0e-4, 220 * bar},
    {"ISO VG 68", false, 880, 68.0e-6, 8.7e-6, 95, 1.53e9, -7.0e6, 10.0, 2.2e-8, 7.0e-4, 220 * bar},
};

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed, 1) {}
  double of(double low, double high) { return random_.uniform(low, high); }
  double by_size(double low, double high) { return low * std::exp(random_.uniform() * std::log(high / low)); }
  bool chance(double p) { return random_.uniform() < p; }
  double about(double x, double part) { return x * random_.uniform(1.0 - part, 1.0 + part); }
  template <class T>
  T one(std::initializer_list<T> of) {
    return of.begin()[random_.below(static_cast<std::uint32_t>(of.size()))];
  }

 private:
  Random random_;
};

// What follows from the rated flow alone.
double grown(const Design& d, double power) { return std::pow(d.rated_flow / middle, power); }

void draw_outline(Design& d, Draw& r) {
  d.oil = oils[r.one({0, 1, 2, 2, 3, 3, 4})];
  d.oil.viscosity_40 = r.about(d.oil.viscosity_40, 0.08);
  d.oil.viscosity_100 = r.about(d.oil.viscosity_100, 0.05);
  d.oil.stiffness = r.about(d.oil.stiffness, 0.08);
  d.rated_flow = (d.oil.flight ? r.by_size(4, 60) : r.by_size(8, 200)) * litre_per_minute;
  d.rated_current =
      (d.oil.flight ? r.one({7.5, 10.0, 15.0, 20.0}) : r.one({10.0, 15.0, 20.0, 30.0, 40.0, 50.0})) * 1e-3;
  d.supply.pressure = (d.oil.flight ? r.one({140.0, 207.0, 207.0, 280.0}) : r.one({70.0, 140.0, 160.0, 210.0})) * bar;
  d.supply.tank = (d.oil.flight ? r.of(3, 7) : r.of(0.5, 3)) * bar;
  d.air = r.of(0.003, 0.012);
  d.null = r.of(-0.01, 0.01);
  d.amplifier = {r.by_size(300, 1500), r.about(1.0, 0.01), r.of(1.0, 1.2)};
  d.no_load_flow = d.rated_flow * std::sqrt((d.supply.pressure - d.supply.tank) / (70 * bar));
}

void draw_spool(Design& d, Draw& r) {
  Spool& e = d.spool;
  e.diameter = std::max(4e-3, 9.2e-3 * grown(d, 0.45) * r.of(0.95, 1.15));
  e.stroke = 0.6e-3 * grown(d, 0.3) * r.of(0.9, 1.15);
  e.stop = e.stroke * r.of(1.08, 1.25);
  e.discharge = r.of(0.62, 0.70);
  e.width = d.rated_flow / (e.discharge * e.stroke * std::sqrt(70 * bar / d.oil.density));
  if (const double most = 0.97 * pi * e.diameter; e.width > most) {
    e.stroke *= e.width / most;
    e.stop *= e.width / most;
    e.width = most;
  }
  const double area = pi / 4 * e.diameter * e.diameter;
  e.mass = 7800.0 * area * 3.6 * e.diameter * r.of(0.8, 1.2);
  e.coulomb = area * d.supply.pressure * r.of(0.001, 0.004);
  e.stiction = e.coulomb * r.of(1.15, 1.6);
  e.stribeck = r.of(2e-3, 6e-3);
  e.bristle = e.coulomb / r.of(1.0e-6, 2.0e-6);
  e.bristle_damping = 0.25 * std::sqrt(e.bristle * e.mass);
  e.clearance = r.of(2.5e-6, 4.5e-6) * grown(d, 0.1);
  e.eccentricity = r.of(1.0, 2.0);
  e.corner = r.of(1e-6, 6e-6);
  const double shared = e.stroke * r.of(-0.006, 0.02);
  for (double& lap : e.lap) lap = shared + e.stroke * r.of(-0.008, 0.008);
  e.transition = r.of(400, 1000);
  e.sheared = 3.0 * e.diameter;
  e.jet = r.of(0.32, 0.42);
  e.damping_length = 0.25 * e.diameter * r.of(0.6, 1.2);
}

// Nozzles and orifices for a crossover of the spool's loop. `share` is the part of the tip's stiffness that the ball
// sees, `damping` that of the motor alone.
void draw_pilot(Design& d, Draw& r, double share, double damping) {
  FirstStage& f = d.first;
  f.gap = 40e-6 * grown(d, 0.25) * r.of(0.8, 1.2);
  f.stop = f.gap * r.of(0.85, 0.97);
  f.mismatch = r.of(-0.03, 0.03);
  f.transition = r.of(15, 50);
  f.nozzle_discharge = r.of(0.62, 0.70);
  f.orifice_discharge = r.of(0.68, 0.80);
  f.mass = 4e-3 * grown(d, 0.3) * r.of(0.8, 1.3);
  d.valve_bandwidth = std::min(90.0 * grown(d, -0.3) * r.of(0.7, 1.4), damping * d.motor_frequency);
  const double area = pi / 4 * d.spool.diameter * d.spool.diameter, drop = d.supply.pressure - d.supply.tank;
  const double nozzle_part = r.of(0.42, 0.55);
  const auto speed = [&](double part) { return std::sqrt(2.0 * part * drop / d.oil.density); };
  double side = 2 * pi * d.valve_bandwidth * area * f.gap / share;  // [m3/s]
  f.nozzle = side / (f.nozzle_discharge * pi * f.gap * speed(nozzle_part));
  // Jets as stiff as the motor would make it sing: a heavier, stiffer motor and a slower valve share the cure.
  const double motor = 2 * pi * d.motor_frequency;
  const double jets = pi / 4 * f.nozzle * f.nozzle * drop / (f.gap * f.mass * motor * motor);
  if (const double over = jets / 0.6; over > 1.0) {
    const double slower = std::pow(over, 0.25);
    f.mass *= std::sqrt(over);
    f.nozzle /= slower;
    side /= slower;
    d.valve_bandwidth /= slower;
  }
  f.orifice = std::sqrt(4 / pi * side / (f.orifice_discharge * speed(0.97 - nozzle_part)));
  f.pilot_flow = 2.0 * side;
  f.screen_drop = r.of(0.01, 0.035) * drop;
  f.screen_laminar = r.of(0.2, 0.7);
  f.screen_volume = 4e-7 * grown(d, 0.6) * r.of(0.7, 1.5);
  f.chamber = area * (d.spool.stop + r.of(2.5e-3, 4e-3));
}

void draw_motor(Design& d, Draw& r) {
  FirstStage& f = d.first;
  const Spool& e = d.spool;
  d.motor_frequency = std::clamp(700.0 * grown(d, -0.2) * r.of(0.65, 1.5), 300.0, 1200.0);
  f.arm = r.of(1.8, 2.8);
  const double damping = r.of(0.2, 0.5), motor = 2 * pi * d.motor_frequency, share = r.of(0.15, 0.6 / f.arm);
  draw_pilot(d, r, share, damping);
  const double whole = f.mass * motor * motor;
  f.wire = share * whole / f.arm;
  f.stiffness = whole - f.arm * f.arm * f.wire;
  f.damping = 2.0 * damping * whole / motor;
  // At rated current and rated drop the spool is at its stroke: the motor holds the wire, the flapper's offset that
  // bears the flow force, and the jets.
  const double area = pi / 4 * e.diameter * e.diameter, drop = d.supply.pressure - d.supply.tank;
  const double flow_force = 2.0 * e.jet * d.rated_flow * std::sqrt(2.0 * d.oil.density * 35 * bar);
  const double pilot_drop = (flow_force + f.wire * e.stroke) / area;
  const double offset = f.gap * pilot_drop / drop, jets = pi / 4 * f.nozzle * f.nozzle * pilot_drop;
  f.torque = (f.arm * f.wire * e.stroke + whole * offset + jets) / d.rated_current;
  f.play = r.chance(0.3) ? r.of(0.0, 1.5e-6) : 0.0;
  f.loop = {r.of(0.003, 0.008), r.of(0.001, 0.006)};
  f.reach = {r.of(0.05, 0.15), r.of(0.3, 0.8)};
}

void draw_lines(Design& d, Draw& r) {
  Lines& l = d.lines;
  const bool direct = r.chance(0.35);
  l.length = direct ? r.of(0.05, 0.12) : r.by_size(0.25, 1.5);
  l.bore = std::sqrt(4 / pi * d.no_load_flow / r.of(3, 7));
  l.bore = std::max(3e-3, std::round(l.bore * 1e3) * 1e-3);
  l.manifold = 3e-5 * grown(d, 1.0) * r.of(0.8, 1.5);
  l.softness = direct ? r.of(0.0, 0.1) : r.of(0.05, 0.5);
  l.taps_at_valve = r.chance(0.5);
}

void draw_actuator(Design& d, Draw& r) {
  Actuator& a = d.actuator;
  d.speed = r.by_size(0.1, 1.0);
  a.area_a = d.no_load_flow / d.speed;
  a.area_b = r.chance(0.5) ? a.area_a : a.area_a * r.of(0.5, 0.9);
  a.stroke = std::clamp(d.speed * r.by_size(0.4, 1.5), 0.05, 0.8);
  a.dead_a = a.area_a * a.stroke * r.of(0.03, 0.1);
  a.dead_b = a.area_b * a.stroke * r.of(0.03, 0.1);
  const double line = pi / 8 * d.lines.bore * d.lines.bore * d.lines.length;
  const auto spring = [&](double area, double dead) {
    return d.oil.stiffness * area * area / ((0.5 * area * a.stroke + dead + line) * (1.0 + d.lines.softness));
  };
  const double oil = spring(a.area_a, a.dead_a) + spring(a.area_b, a.dead_b);
  const auto mass_at = [&](double hertz) { return oil / std::pow(2 * pi * hertz, 2); };
  a.mass = std::clamp(r.by_size(1, 3000), std::clamp(mass_at(250), 1.0, 3000.0), std::clamp(mass_at(12), 1.0, 3000.0));
  const double natural = std::sqrt(oil / a.mass), stall = a.area_a * d.supply.pressure;
  a.coulomb = stall * r.by_size(0.006, 0.03);
  a.stiction = a.coulomb * r.of(1.1, 1.7);
  a.stribeck = r.of(0.03, 0.1) * d.speed;
  a.bristle = a.coulomb / r.of(1e-5, 3e-5);
  a.viscous = std::max(stall * r.of(0.01, 0.04) / d.speed, 2.0 * r.of(0.02, 0.06) * a.mass * natural);
  a.leak = d.rated_flow / d.supply.pressure * r.by_size(0.0005, 0.008);
  a.body = std::max(2.0, a.mass * r.of(0.2, 0.8));
  a.mount = r.chance(0.35) ? oil * r.by_size(3, 12) : 0.0;
  a.mount_damping = 0.06 * 2.0 * std::sqrt(a.mount * a.body);
  d.position_gain = std::min({0.1 * natural, 25.0, 0.1 * 2 * pi * d.valve_bandwidth}) * r.of(0.6, 1.0);
}

void draw_supply(Design& d, Draw& r) {
  Supply& u = d.supply;
  u.pump_droop = r.by_size(0.015, 0.25) * u.pressure / d.no_load_flow;
  u.pump_flow = d.no_load_flow * r.of(1.1, 1.6);
  const double gas = (r.chance(0.7) ? r.by_size(0.2e-3, 3e-3) : 0.05e-3) * grown(d, 1.0);
  u.accumulator = gas / (1.3 * u.pressure);
  const double bore = std::sqrt(4 / pi * d.no_load_flow / r.of(3, 6)), area = pi / 4 * bore * bore;
  const double length = r.by_size(0.2, 2.0);
  u.inertance = d.oil.density * length / area;
  u.loss = (0.03 * length / bore + r.of(1, 4)) * d.oil.density / (2 * area * area);
  u.volume = 1.5e-4 * grown(d, 1.0) * r.of(0.8, 2.0);
  u.return_volume = 3e-4 * grown(d, 1.0) * r.of(0.8, 2.0);
  u.return_area = d.no_load_flow / (0.7 * 0.7 * std::sqrt(2.0 * r.of(1, 4) * bar / d.oil.density));
}

void draw_sensors(Design& d, Draw& r) {
  const auto sensor = [&](double gain, double lag_low, double lag_high, double range, double noise) {
    // 12 to 16 bit over twice the range, and no coarser than its noise fills.
    const double step = std::min(range * 2.0 / r.one({4096.0, 16384.0, 65536.0}), 1.5 * range * noise);
    return Sensor{1.0 + r.of(-gain, gain), r.by_size(lag_low, lag_high), range * noise, step};
  };
  const double stall = d.actuator.area_a * d.supply.pressure;
  d.sensors[ch_spool] = sensor(0.02, 5e-5, 5e-4, d.spool.stop, r.by_size(2e-4, 1e-3));
  d.sensors[ch_piston] = sensor(0.02, 1e-4, 1e-3, 0.5 * d.actuator.stroke, r.by_size(3e-5, 2e-4));
  const double pressure_noise = r.by_size(4e-4, 1.5e-3), lag = r.by_size(5e-5, 8e-4);
  for (const Channel c : {ch_pressure_a, ch_pressure_b, ch_supply})
    d.sensors[c] = sensor(0.015, lag, 1.1 * lag, d.supply.pressure, pressure_noise);
  d.sensors[ch_return] = sensor(0.015, lag, 1.1 * lag, 0.1 * d.supply.pressure, pressure_noise);
  d.sensors[ch_load] = sensor(0.01, 1e-4, 5e-4, stall, r.by_size(2e-4, 1e-3));
  d.sensors[ch_temperature] = {1.0, 0.0, 0.1, 0.1};
  d.sensors[ch_coil] = {1.0 + r.of(-0.005, 0.005), 2e-5, d.rated_current * r.by_size(2e-4, 1e-3),
                        d.rated_current / 2048};
  d.recorded.fill(true);
  d.recorded[ch_spool] = !r.chance(0.25);
  d.recorded[ch_return] = !r.chance(0.3);
  d.recorded[ch_supply] = !r.chance(0.12);
  d.recorded[ch_temperature] = !r.chance(0.25);
  d.recorded[ch_piston] = !d.recorded[ch_spool] || !r.chance(0.08);
  d.loaded = r.chance(0.75);
  d.recorded[ch_load] = d.loaded;
  d.recorded[ch_coil] = r.chance(0.2);
  d.command_recorded = !d.recorded[ch_coil] || r.chance(0.6);
  d.percent = r.chance(0.2);
}

// The command's rates, what the acceptance test asks, and the step that the fastest of the stiff parts allows.
void draw_test(Design& d, Draw& r) {
  d.rate = r.one({500.0, 1000.0, 1000.0, 1000.0, 1000.0, 2000.0, 2000.0, 5000.0, 10000.0});
  // Nobody records a fast valve so slowly, nor pressures without a filter against what is faster than the samples.
  if (d.rate < 6.0 * d.valve_bandwidth) d.rate = std::max(d.rate, 1000.0);
  for (const Channel c : {ch_pressure_a, ch_pressure_b, ch_supply, ch_return})
    d.sensors[c].lag = std::max(d.sensors[c].lag, 0.25 / d.rate);
  d.control_rate = std::max(d.rate, 1000.0);
  if (r.chance(0.2)) d.control_rate = std::min(10000.0, 4.0 * d.control_rate);
  d.acceptance_amplitude = r.of(0.25, 0.8);
  d.acceptance_frequency = r.one({2.0, 5.0, 8.0, 10.0});
  const Spool& e = d.spool;
  const double hot = 0.35 * d.oil.viscosity_40 * d.oil.density;
  const double edge = e.discharge * e.width * 8.0 * e.stop * e.stop / (hot * e.transition);
  // Room enough in the manifold for a step of 3 us.
  const double line = pi / 8 * d.lines.bore * d.lines.bore * d.lines.length;
  d.lines.manifold = std::max(d.lines.manifold, edge * 1.6e9 * 3e-6 / 1.2 - line);
  const double manifold = d.lines.manifold + line;
  const double slew = d.first.pilot_flow / (pi / 2 * e.diameter * e.diameter);
  // Decays may come near to the limit of the method, 2.8 over their rate; what rings is to be followed.
  const double decays =
      std::max({edge * 1.6e9 / manifold, e.bristle * slew / e.coulomb, 2 * pi * d.amplifier.bandwidth});
  const double rings = std::max(std::sqrt(3e7 / e.mass), std::sqrt(8e5 / d.first.mass));
  d.step = std::clamp(std::min(1.9 / decays, 0.8 / rings), 2e-6, 1e-5);
}

}  // namespace

Design draw_design(std::uint64_t seed) {
  Design d{};
  Draw r(seed);
  d.seed = seed;
  draw_outline(d, r);
  draw_spool(d, r);
  draw_motor(d, r);
  draw_lines(d, r);
  draw_actuator(d, r);
  draw_supply(d, r);
  draw_sensors(d, r);
  draw_test(d, r);
  return d;
}

}  // namespace servodx::foreign
