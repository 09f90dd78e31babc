#include "rig/plant.h"

#include <cmath>

#include "base/celsius.h"
#include "servodx/rig.h"

// One arithmetic at every width: the vector unit's add, multiply, divide and root are the scalar ones. The sanitizers
// cannot start before the loader has chosen a clone.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define SERVODX_VECTOR_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define SERVODX_VECTOR_CLONES
#endif

namespace servodx::rig {
namespace {
using std::numbers::pi;

// Damping [N s/m] of a spring between two masses from its damping ratio.
double pair_damping(double ratio, double stiffness, double a, double b) {
  return 2.0 * ratio * std::sqrt(stiffness * a * b / (a + b));
}

// Laminar resistance [1/m3] times viscosity of a conductance stated at 40 degC.
double laminar_of(double conductance, double viscosity_40) { return 1.0 / (conductance * viscosity_40); }

// Places in Plant::plumbing_ and Plant::pilot_.
enum : int { screen, supply_line, return_line, across };
enum : int { into_1, into_2, out_of_1, out_of_2 };

constexpr double copper = 3.9e-3;  // [1/K] rise of resistance over that at 20 degC

}  // namespace

Plant::Plant(const RigModel& m, const Oil& oil, double temperature, const Wear& wear)
    : m_(m),
      oil_(oil),
      tank_enthalpy_(oil.at(m.supply_tank_pressure).enthalpy),
      temperature_(temperature),
      magnetics_(m),
      edges_(m),
      piston_area_a_(m.piston_area_a()),
      piston_area_b_(m.piston_area_b()),
      spool_area_(m.spool_area()),
      moving_(m.has_actuator() ? 1.0 : 0.0),
      surface_damping_(pair_damping(m.actuator_attachment_damping, m.actuator_surface_stiffness, m.actuator_piston_mass,
                                    m.actuator_surface_mass)),
      earth_damping_(2.0 * m.actuator_attachment_damping *
                     std::sqrt(m.actuator_earth_stiffness * m.actuator_body_mass)),
      per_accumulator_(
          1.0 / (0.75 * m.supply_accumulator_volume * std::pow(m.supply_accumulator_precharge + atmosphere, 0.75))),
      per_pump_lag_(1.0 / m.supply_pump_lag),
      per_inertia_(1.0 / m.armature_inertia),
      per_spool_mass_(1.0 / m.spool_mass),
      per_piston_mass_(1.0 / m.actuator_piston_mass),
      per_surface_mass_(1.0 / m.actuator_surface_mass),
      per_body_mass_(1.0 / m.actuator_body_mass) {
  const Oil stated(m, 40.0 + zero_celsius, 0.0);
  const auto line = [&](double drop) {
    return rated_drop(m.supply_line_viscous_drop, drop, m.supply_line_flow, stated.viscosity, stated.density);
  };
  plumbing_.set(supply_line, line(m.supply_line_drop));
  plumbing_.set(return_line, line(m.supply_return_line_drop));
  plumbing_.set(across, closed);
  end_leak_ = pi * m.spool_diameter * std::pow(m.edges_clearance, 3) *
              (1.0 + 1.5 * m.edges_eccentricity * m.edges_eccentricity) / (12.0 * oil.viscosity * m.pilot_land_length);
  const bool flapper = m.first_stage == FirstStage::flapper_nozzle;
  const Restriction fixed =
      flapper ? fixed_orifice(m.nozzles_orifice_diameter, m.nozzles_orifice_length, m.nozzles_orifice_discharge)
              : closed;
  for (int i = 0; i < 4; ++i) pilot_.set(i, fixed);
  nozzle_area_ = flapper ? pi / 4 * m.nozzles_diameter * m.nozzles_diameter : 0.0;
  jet_momentum_ = flapper ? 4.0 * m.nozzles_discharge / m.nozzles_diameter : 0.0;
  cushion_ = m.actuator_cushion_length > 0.0 ? m.actuator_cushion_damping / m.actuator_cushion_length : 0.0;
  turns_ = resistance_ = leakage_ = gain_ = integral_ = null_mmf_ = wire_ = pump_pressure_ = 0.0;
  set_wear(wear);
}

void Plant::set_wear(const Wear& wear) {
  wear_ = wear;
  const Oil stated(m_, 40.0 + zero_celsius, 0.0);

  // Driver and coils: a proportional-integral current controller laid out for the sound, cold circuit.
  const double sound = m_.motor_coil_resistance * m_.circuit_factor();
  const double one_of_two = m_.coil_wiring == CoilWiring::parallel ? 2.0 / (1.0 + wear.coil_path) : 1.0;
  leakage_ = m_.motor_leakage_inductance * m_.circuit_factor() * one_of_two;
  resistance_ = sound * one_of_two * (1.0 + copper * (temperature_ - zero_celsius - 20.0));
  gain_ =
      2.0 * pi * m_.driver_bandwidth * (magnetics_.inductance() + m_.motor_leakage_inductance * m_.circuit_factor());
  per_leakage_ = 1.0 / leakage_;
  per_gain_ = 1.0 / gain_;
  integral_ = 2.0 * pi * m_.driver_bandwidth * sound;
  turns_ = magnetics_.turns * wear.torque_gain;
  const double null = m_.armature_null + m_.armature_null_drift * (temperature_ - zero_celsius - 40.0) + wear.null;
  null_mmf_ = magnetics_.turns * null * m_.driver_rated_current;

  // Screen: pores act side by side, so the flow of each rises as the open area falls.
  const double open = std::fmax(1.0 - wear.filter_blocked, 1e-3);
  Restriction clean = rated_drop(m_.pilot_filter_viscous_drop, m_.pilot_filter_inertial_drop, m_.pilot_filter_flow,
                                 stated.viscosity, stated.density);
  plumbing_.set(screen, {.laminar = clean.laminar / open, .inertial = clean.inertial / (open * open)});
  const double blocked = wear.nozzle_blocked;
  if (m_.first_stage == FirstStage::flapper_nozzle) {
    const double half = 0.5 * m_.nozzles_asymmetry;
    const auto nozzle = [&](double share, double lost) {
      return Nozzle::of(m_.nozzles_diameter, m_.nozzles_discharge * share, m_.nozzles_land_ratio,
                        std::fmax(1.0 - std::fmax(lost, 0.0), 1e-3));
    };
    nozzle_1_ = nozzle(1.0 + half, blocked);
    nozzle_2_ = nozzle(1.0 - half, -blocked);
  } else {
    jet_left_ = std::fmax(1.0 - std::fabs(blocked), 1e-3);
  }

  // Silt stiffens presliding with the force it holds, so that the spool still lets go after the same few microns. A
  // chip holds in the same way.
  const double grip = wear.spool_friction + wear.spool_jam / m_.spool_coulomb;
  spool_friction_ = {m_.spool_coulomb * grip,
                     m_.spool_breakaway * grip,
                     m_.spool_stribeck_speed,
                     m_.spool_bristle_stiffness * grip,
                     m_.spool_bristle_damping * std::sqrt(grip),
                     oil_.viscosity * pi * m_.spool_diameter * m_.spool_sheared_length / m_.edges_clearance};
  edges_ = Edges(m_, wear.edge_clearance, wear.corner_wear);
  wire_ = m_.wire_stiffness * wear.wire_stiffness;

  const double seal = wear.seal_friction;
  piston_friction_ = {m_.actuator_coulomb * seal,
                      m_.actuator_breakaway * seal,
                      m_.actuator_stribeck_speed,
                      m_.actuator_bristle_stiffness * seal,
                      m_.actuator_bristle_damping * std::sqrt(seal),
                      m_.actuator_viscous * oil_.viscosity / stated.viscosity};
  if (m_.ports == Ports::actuator) {
    const double leak = m_.actuator_leakage + wear.piston_leakage;
    plumbing_.set(across, leak > 0.0 ? Restriction{.laminar = laminar_of(leak, stated.viscosity)} : closed);
  } else if (m_.ports == Ports::free) {
    plumbing_.set(across, {.laminar = laminar_of(m_.supply_line_flow / m_.bench_loop_drop, stated.viscosity)});
  }
  pump_pressure_ = m_.supply_pressure * wear.supply_pressure;
}

// Jet pipe: what the jet covers of each receiver lets oil in, the rest of the receiver lets it out, and the part of the
// jet that misses both goes to return.
Plant::Jets Plant::jets(double x) const {
  const double jet = 0.5 * m_.jet_pipe_jet_diameter * std::sqrt(jet_left_), hole = 0.5 * m_.jet_pipe_receiver_diameter;
  const double half = 0.5 * m_.jet_pipe_receiver_spacing, least = 1e-3 * pi * hole * hole;
  const double covered_1 = shared_area(jet, hole, std::fabs(half - x));
  const double covered_2 = shared_area(jet, hole, std::fabs(half + x));
  const auto hole_of = [&](double area) {
    const double a = std::fmax(area, least);
    return orifice(m_.jet_pipe_discharge, a, 2.0 * std::sqrt(a / pi), hole_flow_number);
  };
  Jets all{{}, hole_of(pi * jet * jet - covered_1 - covered_2)};
  all.pilot.set(into_1, hole_of(covered_1));
  all.pilot.set(into_2, hole_of(covered_2));
  all.pilot.set(out_of_1, hole_of(pi * hole * hole - covered_1));
  all.pilot.set(out_of_2, hole_of(pi * hole * hole - covered_2));
  return all;
}

// In the order of the states, accumulator last.
inline std::array<Four, 2> Plant::volumes(const State& s) const {
  const double swept = spool_area_ * s[x_spool];
  return {four(m_.pilot_filter_volume, m_.pilot_chamber_volume + swept, m_.pilot_chamber_volume - swept, volume_a(s)),
          four(volume_b(s), m_.supply_manifold_volume, m_.supply_manifold_volume, 1.0)};
}

SERVODX_VECTOR_CLONES
void Plant::rates(const State& s, const Inputs& in, const Hysteresis& hysteresis, State& ds, Flows& f) const {
  // 1 driver, coils and torque motor
  const double error = in.demand - s[current];
  const double wanted_voltage = gain_ * error + s[controller];
  const double voltage = limited(wanted_voltage, -m_.driver_voltage, m_.driver_voltage);
  const double reaching = m_.coil_wiring == CoilWiring::parallel ? voltage : voltage * wear_.coil_path;
  const double bias = null_mmf_ + magnetics_.turns * in.offset * m_.driver_rated_current;
  const double held = hysteresis.mmf(s[flux]);
  const auto magnetic = magnetics_.at(turns_ * s[current] + bias, s[flux], s[angle], held);
  ds[controller] = integral_ * (error + (voltage - wanted_voltage) * per_gain_);  // does not wind up at the limit
  ds[current] = (reaching - resistance_ * s[current] - turns_ * magnetic.flux_rate) * per_leakage_;
  ds[flux] = magnetic.flux_rate;
  f.motor_torque = magnetic.torque;

  // 2 restrictions, from the positions of flapper and spool, and the flows through them
  const double p_tank = m_.supply_tank_pressure;
  const double x_flapper = m_.armature_nozzle_arm * s[angle];  // towards nozzle 1
  const double gap_1 = m_.nozzles_gap - x_flapper, gap_2 = m_.nozzles_gap + x_flapper;
  Restrictions pilot = pilot_;
  double q_bypass = 0.0;
  if (m_.first_stage == FirstStage::flapper_nozzle) {
    const Restriction n1 = nozzle_1_.at(gap_1), n2 = nozzle_2_.at(gap_2);
    pilot.laminar = four(pilot_.laminar[0], pilot_.laminar[1], n1.laminar, n2.laminar);
    pilot.transition = four(pilot_.transition[0], pilot_.transition[1], n1.transition, n2.transition);
    pilot.turbulent = four(pilot_.turbulent[0], pilot_.turbulent[1], n1.turbulent, n2.turbulent);
    pilot.inertial = four(pilot_.inertial[0], pilot_.inertial[1], n1.inertial, n2.inertial);
  } else {
    const Jets all = jets(x_flapper);
    pilot = all.pilot;
    q_bypass = flow_through(all.bypass, oil_.viscosity, oil_.density, s[p_filter] - s[p_return]);
  }
  const double x = s[x_spool];
  const Edges::Shape edge = edges_.at(x);
  const FourFlows in_plumbing = flows_through(plumbing_, oil_, four(s[p_supply], s[p_accumulator], s[p_return], s[p_a]),
                                              four(s[p_filter], s[p_supply], p_tank, s[p_b]));
  const FourFlows in_pilot = flows_through(pilot, oil_, four(s[p_filter], s[p_filter], s[p_pilot_1], s[p_pilot_2]),
                                           four(s[p_pilot_1], s[p_pilot_2], s[p_return], s[p_return]));
  const FourFlows at_edges = flows_through(edge.law, oil_, four(s[p_supply], s[p_a], s[p_supply], s[p_b]),
                                           four(s[p_a], s[p_return], s[p_b], s[p_return]));
  const double dp_1 = s[p_pilot_1] - s[p_return], dp_2 = s[p_pilot_2] - s[p_return];
  const double q_end_1 = end_leak_ * dp_1, q_end_2 = end_leak_ * dp_2;
  f.q_filter = in_plumbing.reference[screen];
  f.q_supply = in_plumbing.reference[supply_line];
  f.q_return = in_plumbing.reference[return_line];
  f.q_across = in_plumbing.reference[across];
  f.q_nozzle_1 = in_pilot.reference[out_of_1], f.q_nozzle_2 = in_pilot.reference[out_of_2];
  f.q_pa = at_edges.reference[edge_pa], f.q_at = at_edges.reference[edge_at];
  f.q_pb = at_edges.reference[edge_pb], f.q_bt = at_edges.reference[edge_bt];
  f.q_a = f.q_pa - f.q_at;
  f.q_b = f.q_pb - f.q_bt;

  // 3 oil at the nodes: net inflow of reference oil against growth of the volume
  const double v_rod = moving_ * (s[v_piston] - s[v_body]), x_rod = s[x_piston] - s[x_body];
  const double end_growth = spool_area_ * s[v_spool];
  const std::array<Four, 2> volume = volumes(s);
  const std::array<Four, 2> inflow{
      four(f.q_filter - in_pilot.reference[into_1] - in_pilot.reference[into_2] - q_bypass,
           in_pilot.reference[into_1] - f.q_nozzle_1 - q_end_1, in_pilot.reference[into_2] - f.q_nozzle_2 - q_end_2,
           f.q_a - f.q_across),
      four(f.q_b + f.q_across, f.q_supply - f.q_filter - f.q_pa - f.q_pb,
           f.q_at + f.q_bt + f.q_nozzle_1 + f.q_nozzle_2 + q_end_1 + q_end_2 + q_bypass - f.q_return, -f.q_supply)};
  const std::array<Four, 2> swell{four(0.0, end_growth, -end_growth, piston_area_a_ * v_rod),
                                  four(-piston_area_b_ * v_rod, 0.0, 0.0, 0.0)};
  double throttled = -f.q_return * tank_enthalpy_;  // enthalpy that the restrictions took
  double accumulator_enthalpy = 0.0;
  for (int k = 0; k < 2; ++k) {
    const double* p = s.data() + p_filter + 4 * k;
    const auto oil = oil_.at(four(p[0], p[1], p[2], p[3]));
    // (inflow v - growth) over volume * compliance, the compliance being slope / v
    const Four rate = oil.volume * (inflow[k] * oil.volume - swell[k]) / (volume[k] * oil.slope);
    for (int i = 0; i < 4; ++i) ds[p_filter + 4 * k + i] = rate[i];
    throttled -= sum(inflow[k] * oil.enthalpy);
    accumulator_enthalpy = oil.enthalpy[3];
  }
  // Accumulator: gas on a polytrope of exponent 4/3; pump: lagged compensator.
  const double gas = s[p_accumulator] + atmosphere, root = std::sqrt(gas), fourth = std::sqrt(root);
  ds[p_accumulator] = (s[q_pump] - f.q_supply) * gas * root * fourth * per_accumulator_;
  const double wanted = limited(m_.supply_pump_gain * (pump_pressure_ - s[p_accumulator]), 0.0, m_.supply_pump_flow);
  ds[q_pump] = (wanted - s[q_pump]) * per_pump_lag_;

  // 4 armature: magnetic torque, flexure, wire, jets (pressure and momentum, Merritt 1967 eq. 6-69), stops
  f.wire_force = -wire_ * beyond_clearance(x + m_.armature_ball_arm * s[angle], wear_.wire_clearance);
  const double flapper_speed = m_.armature_nozzle_arm * s[angle_rate];
  const double jet = jet_momentum_;
  const double jets =
      nozzle_area_ * (dp_2 * (1.0 + jet * jet * gap_2 * gap_2) - dp_1 * (1.0 + jet * jet * gap_1 * gap_1));
  const double flapper_stop = stop_force(x_flapper, flapper_speed, m_.armature_stop, m_.armature_stop_stiffness, 2.0);
  ds[angle] = s[angle_rate];
  ds[angle_rate] = (magnetic.torque - m_.armature_flexure * s[angle] - m_.armature_damping * s[angle_rate] +
                    m_.armature_ball_arm * f.wire_force + m_.armature_nozzle_arm * (jets + flapper_stop)) *
                   per_inertia_;

  // 5 spool: steady flow force closes the edges that carry flow; transient force damps on the supply side
  const auto momentum = [&](int i) {
    const double flow = at_edges.volume[i];
    return at_edges.density[i] * flow * flow * edge.inverse_area[i] * edge.cosine[i];
  };
  const auto inertia = [&](int i) { return std::fabs(at_edges.volume[i]) * edge.inverse_gap[i] * edge.growth[i]; };
  const double steady = momentum(edge_at) + momentum(edge_pb) - momentum(edge_pa) - momentum(edge_bt);
  const double transient = -oil_.density * m_.spool_damping_length * s[v_spool] * (inertia(edge_pa) + inertia(edge_pb));
  f.flow_force = steady + transient;
  const auto rub = spool_friction_.at(s[v_spool], s[z_spool]);
  f.spool_friction = -rub.force;
  const double spool_stop = stop_force(x, s[v_spool], m_.spool_stop, m_.spool_stop_stiffness, 2.0);
  ds[x_spool] = s[v_spool];
  ds[v_spool] =
      (spool_area_ * (s[p_pilot_1] - s[p_pilot_2]) + f.wire_force + f.flow_force + f.spool_friction + spool_stop) *
      per_spool_mass_;
  ds[z_spool] = rub.rate;

  // 6 piston, body and surface; on a test stand nothing moves
  const auto seal = piston_friction_.at(v_rod, s[z_piston]);
  const double half = 0.5 * m_.actuator_stroke;
  const double into = std::fabs(x_rod) - (half - m_.actuator_cushion_length);
  const double cushion = into > 0.0 && x_rod * v_rod > 0.0 ? -cushion_ * into * v_rod : 0.0;
  f.piston_friction = -seal.force;
  const double end_stop = cushion + stop_force(x_rod, v_rod, half, m_.actuator_stop_stiffness, 2.0);
  const double on_piston = piston_area_a_ * s[p_a] - piston_area_b_ * s[p_b] - seal.force + end_stop;
  const double slip = s[v_piston] - s[v_surface];
  const double rod =  // on the surface
      m_.actuator_surface_stiffness * (s[x_piston] - s[x_surface]) + surface_damping_ * slip;
  const double load = in.force + in.force_stiffness * s[x_surface];
  ds[z_piston] = moving_ * seal.rate;
  ds[x_piston] = moving_ * s[v_piston];
  ds[v_piston] = moving_ * (on_piston - rod) * per_piston_mass_;
  ds[x_surface] = moving_ * s[v_surface];
  ds[v_surface] = moving_ * (rod - load) * per_surface_mass_;
  ds[x_body] = moving_ * s[v_body];
  ds[v_body] =
      moving_ * (-on_piston - m_.actuator_earth_stiffness * s[x_body] - earth_damping_ * s[v_body]) * per_body_mass_;

  // 7 audit. Jets and flow force work out of what the restrictions release.
  ds[oil_in] = f.q_supply;
  ds[oil_out] = f.q_return;
  ds[energy_in] = reaching * s[current] + bias * magnetic.flux_rate + f.q_supply * accumulator_enthalpy -
                  f.q_return * tank_enthalpy_ - moving_ * load * s[v_surface];
  ds[energy_lost] =
      resistance_ * s[current] * s[current] + (held + magnetics_.eddy * magnetic.flux_rate) * magnetic.flux_rate +
      m_.armature_damping * s[angle_rate] * s[angle_rate] - (jets + flapper_stop) * flapper_speed + throttled -
      (f.spool_friction + f.flow_force + spool_stop) * s[v_spool] +
      moving_ *
          ((seal.force - end_stop) * v_rod + surface_damping_ * slip * slip + earth_damping_ * s[v_body] * s[v_body]);
}

State Plant::rest() const {
  State s{};
  s[p_supply] = s[p_accumulator] = s[p_filter] = pump_pressure_;
  s[p_return] = m_.supply_tank_pressure;
  const double both = pump_pressure_ + m_.supply_tank_pressure;
  s[p_pilot_1] = s[p_pilot_2] = 0.5 * both;
  // Balanced edges share the supply, the piston balances the forces.
  s[p_a] = both * (piston_area_b_ / (piston_area_a_ + piston_area_b_));
  s[p_b] = both * (piston_area_a_ / (piston_area_a_ + piston_area_b_));
  return s;
}

double Plant::volume_a(const State& s) const {
  if (moving_ == 0.0) return m_.bench_volume;
  return m_.actuator_dead_volume + piston_area_a_ * (0.5 * m_.actuator_stroke + (s[x_piston] - s[x_body]));
}
double Plant::volume_b(const State& s) const {
  if (moving_ == 0.0) return m_.bench_volume;
  return m_.actuator_dead_volume + piston_area_b_ * (0.5 * m_.actuator_stroke - (s[x_piston] - s[x_body]));
}

double Plant::stored_oil(const State& s) const {
  const auto volume = volumes(s);
  double total = 0.0;
  for (int i = 0; i < 7; ++i) total += oil_.stored(s[p_filter + i], volume[i / 4][i % 4]);
  return total;
}

double Plant::stored_energy(const State& s) const {
  const auto volume = volumes(s);
  const auto half_square = [](double factor, double x) { return 0.5 * factor * x * x; };
  double total =
      magnetics_.energy(s[flux], s[angle]) + half_square(leakage_, s[current]) +
      half_square(m_.armature_inertia, s[angle_rate]) + half_square(m_.armature_flexure, s[angle]) +
      half_square(wire_, beyond_clearance(s[x_spool] + m_.armature_ball_arm * s[angle], wear_.wire_clearance)) +
      half_square(m_.spool_mass, s[v_spool]);
  for (int i = 0; i < 7; ++i) total += oil_.energy(s[p_filter + i], volume[i / 4][i % 4]);
  if (moving_ == 0.0) return total;
  return total + half_square(m_.actuator_piston_mass, s[v_piston]) +
         half_square(m_.actuator_surface_mass, s[v_surface]) + half_square(m_.actuator_body_mass, s[v_body]) +
         half_square(m_.actuator_surface_stiffness, s[x_piston] - s[x_surface]) +
         half_square(m_.actuator_earth_stiffness, s[x_body]);
}

}  // namespace servodx::rig
