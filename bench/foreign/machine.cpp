#include "machine.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace servodx::foreign {
namespace {
using std::numbers::pi;

constexpr double spool_contact = 3e7;    // [N/m] steel end cap, order of magnitude
constexpr double flapper_contact = 8e5;  // [N/m] face of a nozzle
constexpr double contact_loss = 0.4;     // [1] damping ratio of a contact

// What a stop at +-limit pushes back with; damped while in contact, never pulling.
double stop_force(double x, double v, double limit, double stiffness, double damping) {
  if (x > limit) return -std::max(0.0, stiffness * (x - limit) + damping * v);
  if (x < -limit) return std::max(0.0, stiffness * (-limit - x) - damping * v);
  return 0.0;
}

// The hyperbolic tangent by its Pade quotient, 1 from 3 on, where quotient and slope meet.
double saturated(double x) { return x >= 3.0 ? 1.0 : x * (27.0 + x * x) / (27.0 + 9.0 * x * x); }

// LuGre (Canudas de Wit, Olsson, Astrom, Lischinsky 1995): bristle rate and friction force; the Stribeck curve is that
// of Hess and Soom (1990).
struct Bristle {
  double rate, force;
};
Bristle lugre(double v, double z, double coulomb, double breakaway, double stribeck, double stiffness, double damping) {
  const double ratio = v / stribeck;
  const double level = coulomb + (breakaway - coulomb) / (1.0 + ratio * ratio);
  const double rate = v - stiffness * std::abs(v) / level * z;
  return {rate, stiffness * z + damping * rate};
}

}  // namespace

Machine::Machine(const Design& design, const Condition& condition)
    : d_(design),
      c_(condition),
      oil_(design.oil, condition.celsius, condition.air, condition.viscosity),
      rho_(oil_.density()),
      spool_area_(pi / 4 * d_.spool.diameter * d_.spool.diameter),
      nozzle_area_(pi / 4 * d_.first.nozzle * d_.first.nozzle),
      clearance_(d_.spool.clearance * c_.clearance),
      rounding_(clearance_ + 0.5 * d_.spool.corner),
      line_area_(pi / 4 * d_.lines.bore * d_.lines.bore) {
  const Lines& l = d_.lines;
  line_laminar_ = 128.0 * oil_.viscosity(0.5 * d_.supply.pressure) * l.length / (pi * std::pow(l.bore, 4));
  line_turbulent_ = (0.03 * l.length / l.bore + 1.5) * rho_ / (2.0 * line_area_ * line_area_);
  const double half_line = 0.5 * line_area_ * l.length, half = 0.5 * d_.actuator.stroke;
  volume_a_ = d_.actuator.area_a * half + d_.actuator.dead_a + half_line;
  volume_b_ = d_.actuator.area_b * half + d_.actuator.dead_b + half_line;
  softness_a_ = c_.hose + l.softness * volume_a_ / d_.oil.stiffness;
  softness_b_ = c_.hose + l.softness * volume_b_ / d_.oil.stiffness;
  spool_coulomb_ = d_.spool.coulomb * c_.spool_friction;
  spool_breakaway_ = d_.spool.stiction * c_.spool_friction + c_.stiction;
  // Dirt that grips harder is stiffer too, but not in proportion.
  spool_bristle_ = d_.spool.bristle * std::sqrt(c_.spool_friction);
  spool_viscous_ = oil_.viscosity(0.0) * pi * d_.spool.diameter * d_.spool.sheared / clearance_;
  mount_ = c_.mount > 0.0 ? c_.mount : d_.actuator.mount;
  mount_damping_ = c_.mount > 0.0 ? 0.06 * 2.0 * std::sqrt(c_.mount * d_.actuator.body) : d_.actuator.mount_damping;
  const double open = 1.0 - c_.blocked_screen, flow = d_.first.pilot_flow;
  const double warmth = oil_.viscosity(0.0) / (d_.oil.viscosity_40 * d_.oil.density);
  screen_a_ = d_.first.screen_drop * (1.0 - d_.first.screen_laminar) / (flow * flow * open * open);
  screen_b_ = d_.first.screen_drop * d_.first.screen_laminar * warmth / (flow * open);
}

double Machine::orifice(double area, double width, double discharge, double p_from, double p_to) const {
  const double dp = p_from - p_to, speed = std::sqrt(2.0 * std::abs(dp) / rho_);
  const double number = width * speed * rho_ / oil_.viscosity(0.5 * (p_from + p_to));
  const double flow = discharge * area * speed * number / (number + d_.first.transition);
  return std::copysign(flow, dp);
}

// A rounded orifice in series with the land that is left: opening < 0 is overlap.
double Machine::edge_flow(double opening, double p_from, double p_to) const {
  const Spool& e = d_.spool;
  const double dp = p_from - p_to, size = std::abs(dp);
  if (size == 0.0) return 0.0;
  const double root = std::sqrt(opening * opening + 4.0 * rounding_ * rounding_);
  const double open = 0.5 * (opening + root), land = 0.5 * (root - opening);
  const double gap = std::sqrt(open * open + clearance_ * clearance_);
  const double speed = std::sqrt(2.0 * size / rho_), viscosity = oil_.viscosity(0.5 * (p_from + p_to));
  const double number = 2.0 * gap * speed * rho_ / viscosity;
  const double jet = e.discharge * e.width * gap * speed * saturated(2.0 * number / e.transition);
  // The film is as thick as the clearance under a land, and opens with the edge.
  const double film = e.eccentricity * e.width * gap * gap * clearance_ * size / (12.0 * viscosity * land);
  return std::copysign(jet * film / (jet + film), dp);
}

void Machine::motor(const State& s, const Drive& in, State& ds) const {
  const FirstStage& f = d_.first;
  const double rated = d_.rated_current, limit = d_.amplifier.limit * rated;
  const double asked = std::clamp(d_.amplifier.gain * in.demand, -limit, limit);
  ds[current] = (asked - s[current]) * 2.0 * pi * d_.amplifier.bandwidth;
  const double pace = ds[current] / rated;
  ds[loop_1] = (pace - std::abs(pace) * s[loop_1]) / f.reach[0];
  ds[loop_2] = (pace - std::abs(pace) * s[loop_2]) / f.reach[1];
  const double lost = c_.hysteresis * (f.loop[0] * s[loop_1] + f.loop[1] * s[loop_2]);
  const double pull = c_.torque * f.torque * (s[current] - lost * rated) + f.torque * c_.null * rated;

  const double stretch = s[x_spool] + f.arm * s[x_flapper], half = 0.5 * (f.play + c_.play);
  const double wire = c_.wire * f.wire * (stretch - std::clamp(stretch, -half, half));
  const double reach = 4.0 * pi * f.nozzle_discharge * f.nozzle_discharge;
  const double near = f.gap - s[x_flapper], far = f.gap + s[x_flapper];
  const double back = s[p_return];
  const double jets = (s[p_pilot_1] - back) * (nozzle_area_ + reach * near * near) -
                      (s[p_pilot_2] - back) * (nozzle_area_ + reach * far * far);
  const double stop = stop_force(s[x_flapper], s[v_flapper], f.stop, flapper_contact,
                                 contact_loss * 2.0 * std::sqrt(flapper_contact * f.mass));
  ds[x_flapper] = s[v_flapper];
  ds[v_flapper] = (pull - f.stiffness * s[x_flapper] - f.damping * s[v_flapper] - f.arm * wire - jets + stop) / f.mass;
}

void Machine::pilot(const State& s, State& ds, Flows& flows) const {
  const FirstStage& f = d_.first;
  const double dp = s[p_supply] - s[p_screen];
  flows.screen = std::copysign(
      2.0 * std::abs(dp) / (screen_b_ + std::sqrt(screen_b_ * screen_b_ + 4.0 * screen_a_ * std::abs(dp))), dp);
  const double bore = pi / 4 * f.orifice * f.orifice;
  flows.orifice_1 = orifice(bore, f.orifice, f.orifice_discharge, s[p_screen], s[p_pilot_1]);
  flows.orifice_2 = orifice(bore, f.orifice, f.orifice_discharge, s[p_screen], s[p_pilot_2]);
  const double least = 0.02 * f.gap;
  const double near = std::max(least, f.gap * (1.0 - 0.5 * f.mismatch) - s[x_flapper]);
  const double far = std::max(least, f.gap * (1.0 + 0.5 * f.mismatch) + s[x_flapper]);
  const double left = 1.0 - c_.blocked_nozzle, ring = pi * f.nozzle;
  flows.nozzle_1 = orifice(left * ring * near, 2.0 * near, f.nozzle_discharge, s[p_pilot_1], s[p_return]);
  flows.nozzle_2 = orifice(ring * far, 2.0 * far, f.nozzle_discharge, s[p_pilot_2], s[p_return]);
  const double swept = spool_area_ * s[v_spool], moved = spool_area_ * s[x_spool];
  ds[p_screen] = oil_.stiffness(s[p_screen]) / f.screen_volume * (flows.screen - flows.orifice_1 - flows.orifice_2);
  ds[p_pilot_1] = oil_.stiffness(s[p_pilot_1]) / (f.chamber + moved) * (flows.orifice_1 - flows.nozzle_1 - swept);
  ds[p_pilot_2] = oil_.stiffness(s[p_pilot_2]) / (f.chamber - moved) * (flows.orifice_2 - flows.nozzle_2 + swept);
}

void Machine::metering(const State& s, Flows& flows) const {
  const double x = s[x_spool];
  const auto lap = [&](Edge e) { return d_.spool.lap[e] + c_.lap[e]; };
  flows.edge[edge_pa] = edge_flow(x - lap(edge_pa), s[p_supply], s[p_valve_a]);
  flows.edge[edge_bt] = edge_flow(x - lap(edge_bt), s[p_valve_b], s[p_return]);
  flows.edge[edge_pb] = edge_flow(-x - lap(edge_pb), s[p_supply], s[p_valve_b]);
  flows.edge[edge_at] = edge_flow(-x - lap(edge_at), s[p_valve_a], s[p_return]);
}

void Machine::spool(const State& s, State& ds, const Flows& flows) const {
  const Spool& e = d_.spool;
  const FirstStage& f = d_.first;
  const auto momentum = [&](Edge k, double dp) {
    return std::abs(flows.edge[k]) * std::sqrt(2.0 * rho_ * std::abs(dp));
  };
  const double closing = momentum(edge_pa, s[p_supply] - s[p_valve_a]) + momentum(edge_bt, s[p_valve_b] - s[p_return]) -
                         momentum(edge_pb, s[p_supply] - s[p_valve_b]) - momentum(edge_at, s[p_valve_a] - s[p_return]);
  const double steady = c_.flow_force * e.jet * closing;
  const double unsteady =
      e.damping_length * e.discharge * e.width * std::sqrt(rho_ * std::abs(s[p_supply] - s[p_return])) * s[v_spool];
  const double stretch = s[x_spool] + f.arm * s[x_flapper], half = 0.5 * (f.play + c_.play);
  const double wire = c_.wire * f.wire * (stretch - std::clamp(stretch, -half, half));
  const Bristle grip =
      lugre(s[v_spool], s[z_spool], spool_coulomb_, spool_breakaway_, e.stribeck, spool_bristle_, e.bristle_damping);
  const double stop =
      stop_force(s[x_spool], s[v_spool], e.stop, spool_contact, contact_loss * 2.0 * std::sqrt(spool_contact * e.mass));
  ds[x_spool] = s[v_spool];
  ds[z_spool] = grip.rate;
  ds[v_spool] = (spool_area_ * (s[p_pilot_1] - s[p_pilot_2]) - steady - unsteady - wire - grip.force -
                 spool_viscous_ * s[v_spool] + stop) /
                e.mass;
}

void Machine::lines(const State& s, State& ds, const Flows& flows) const {
  const Lines& l = d_.lines;
  const double inertance = rho_ * l.length / line_area_;
  const auto drop = [&](double q) { return (line_laminar_ + line_turbulent_ * std::abs(q)) * q; };
  const double volume = l.manifold + 0.5 * line_area_ * l.length;
  const double into_a = flows.edge[edge_pa] - flows.edge[edge_at] - s[q_line_a];
  const double into_b = flows.edge[edge_pb] - flows.edge[edge_bt] - s[q_line_b];
  ds[p_valve_a] = oil_.stiffness(s[p_valve_a]) / volume * into_a;
  ds[p_valve_b] = oil_.stiffness(s[p_valve_b]) / volume * into_b;
  ds[q_line_a] = (s[p_valve_a] - s[p_chamber_a] - drop(s[q_line_a])) / inertance;
  ds[q_line_b] = (s[p_valve_b] - s[p_chamber_b] - drop(s[q_line_b])) / inertance;
}

void Machine::supply(const State& s, State& ds, const Flows& flows) const {
  const Supply& u = d_.supply;
  const double set = c_.supply * u.pressure;
  const double pump = std::clamp((set - s[p_accumulator]) / u.pump_droop, 0.0, u.pump_flow);
  const double taken = flows.screen + flows.edge[edge_pa] + flows.edge[edge_pb];
  const double given = flows.nozzle_1 + flows.nozzle_2 + flows.edge[edge_at] + flows.edge[edge_bt];
  // The sag of the pump sets the slow part, its line and the accumulator the ringing.
  ds[p_accumulator] = (pump - s[q_supply]) / u.accumulator;
  ds[q_supply] = (s[p_accumulator] - s[p_supply] - u.loss * std::abs(s[q_supply]) * s[q_supply]) / u.inertance;
  ds[p_supply] = oil_.stiffness(s[p_supply]) / u.volume * (s[q_supply] - taken);
  const double out = orifice(u.return_area, 2e-3, 0.7, s[p_return], u.tank);
  ds[p_return] = oil_.stiffness(s[p_return]) / u.return_volume * (given - out);
}

void Machine::cylinder(const State& s, const Drive& in, State& ds, Flows& flows) const {
  const Actuator& a = d_.actuator;
  const double travel = s[x_piston] - s[x_body], speed = s[v_piston] - s[v_body];
  flows.across = (a.leak + c_.leak) * (s[p_chamber_a] - s[p_chamber_b]);
  const double room_a = std::max(volume_a_ + a.area_a * travel, 0.02 * volume_a_);
  const double room_b = std::max(volume_b_ - a.area_b * travel, 0.02 * volume_b_);
  const double compliance_a = room_a / oil_.stiffness(s[p_chamber_a]) + softness_a_;
  const double compliance_b = room_b / oil_.stiffness(s[p_chamber_b]) + softness_b_;
  ds[p_chamber_a] = (s[q_line_a] - a.area_a * speed - flows.across) / compliance_a;
  ds[p_chamber_b] = (s[q_line_b] + a.area_b * speed + flows.across) / compliance_b;

  const Bristle grip = lugre(speed, s[z_piston], a.coulomb, a.stiction, a.stribeck, a.bristle, 0.0);
  const double contact = std::min(1e9, 2.0 * a.area_a * d_.supply.pressure / 1e-4);
  const double stop =
      stop_force(travel, speed, 0.5 * a.stroke, contact, contact_loss * 2.0 * std::sqrt(contact * a.mass));
  const double push = a.area_a * s[p_chamber_a] - a.area_b * s[p_chamber_b] - grip.force - a.viscous * speed + stop;
  flows.load = in.force + in.spring * s[x_piston] + in.drag * s[v_piston];
  ds[x_piston] = s[v_piston];
  ds[v_piston] = (push - flows.load) / a.mass;
  ds[z_piston] = grip.rate;
  const bool rigid = mount_ <= 0.0;
  ds[x_body] = rigid ? 0.0 : s[v_body];
  ds[v_body] = rigid ? 0.0 : (-push - mount_ * s[x_body] - mount_damping_ * s[v_body]) / a.body;
}

void Machine::rates(const State& s, const Drive& in, State& ds, Flows& flows) const {
  motor(s, in, ds);
  pilot(s, ds, flows);
  metering(s, flows);
  spool(s, ds, flows);
  lines(s, ds, flows);
  supply(s, ds, flows);
  cylinder(s, in, ds, flows);
}

void Machine::step(State& s, const Drive& in, double h) const {
  State k1, k2, k3, k4, at;
  Flows flows;
  rates(s, in, k1, flows);
  for (int i = 0; i < n_vars; ++i) at[i] = s[i] + 0.5 * h * k1[i];
  rates(at, in, k2, flows);
  for (int i = 0; i < n_vars; ++i) at[i] = s[i] + 0.5 * h * k2[i];
  rates(at, in, k3, flows);
  for (int i = 0; i < n_vars; ++i) at[i] = s[i] + h * k3[i];
  rates(at, in, k4, flows);
  for (int i = 0; i < n_vars; ++i) s[i] += h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
}

State Machine::rest() const {
  State s{};
  const double supply = c_.supply * d_.supply.pressure, back = d_.supply.tank;
  const double ratio = d_.actuator.area_a / d_.actuator.area_b;
  s[p_supply] = s[p_accumulator] = supply;
  s[p_return] = back;
  s[p_screen] = 0.97 * supply;
  s[p_pilot_1] = s[p_pilot_2] = 0.5 * (supply + back);
  // Both edges share the drop, the piston is in balance.
  s[p_chamber_b] = (supply + back) * ratio / (1.0 + ratio);
  s[p_chamber_a] = s[p_chamber_b] / ratio;
  s[p_valve_a] = s[p_chamber_a];
  s[p_valve_b] = s[p_chamber_b];
  return s;
}

}  // namespace servodx::foreign
