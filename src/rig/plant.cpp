#include "rig/plant.h"

#include <cmath>

namespace servodx::rig {
namespace {
using std::numbers::pi;

Nozzle nozzle(const RigModel& m, const Fluid& oil, double share) {
  return {.curtain = pi * m.pilot_nozzle_diameter,
          .discharge = m.pilot_nozzle_discharge * share,
          .density = oil.density,
          .creeping = 6.0 * oil.viscosity * std::log(m.pilot_nozzle_land_ratio) / pi};
}

// Damping [N s/m] of a spring between two masses from its damping ratio.
double pair_damping(double ratio, double stiffness, double a, double b) {
  return 2.0 * ratio * std::sqrt(stiffness * a * b / (a + b));
}

// Viscosity over that at 40 degC, for what is stated there.
double thickness(const RigModel& m, const Fluid& oil) {
  return oil.viscosity / Fluid(m, 40.0 + zero_celsius, 0.0).viscosity;
}

}  // namespace

Plant::Plant(const RigModel& m, const Fluid& oil, double temperature, const Wear& wear)
    : m_(m),
      oil_(oil),
      temperature_(temperature),
      magnetics_(m),
      edge_(m, oil, 1.0),
      nozzle_1_(nozzle(m, oil, 1.0 + 0.5 * m.pilot_nozzle_asymmetry)),
      nozzle_2_(nozzle(m, oil, 1.0 - 0.5 * m.pilot_nozzle_asymmetry)),
      piston_friction_{m.actuator_coulomb,         m.actuator_breakaway,
                       m.actuator_stribeck_speed,  m.actuator_bristle_stiffness,
                       m.actuator_bristle_damping, m.actuator_viscous * thickness(m, oil)},
      orifice_(fixed_orifice(oil, m.pilot_orifice_diameter, m.pilot_orifice_length, m.pilot_orifice_discharge)),
      supply_line_(rated_drop(m.supply_line_drop, m.supply_line_flow)),
      return_line_(rated_drop(m.supply_return_line_drop, m.supply_line_flow)),
      piston_area_(m.piston_area()),
      spool_area_(m.spool_area()),
      nozzle_area_(pi / 4 * m.pilot_nozzle_diameter * m.pilot_nozzle_diameter),
      end_leak_(pi * m.spool_diameter * std::pow(m.ports_clearance, 3) *
                (1.0 + 1.5 * m.ports_eccentricity * m.ports_eccentricity) /
                (12.0 * oil.viscosity * m.pilot_land_length)),
      piston_leak_(m.actuator_leakage / thickness(m, oil)),
      driver_rate_(2.0 * pi * m.driver_bandwidth),
      jet_cosine_(std::cos(m.spool_jet_angle * pi / 180.0)),
      surface_damping_(pair_damping(m.actuator_attachment_damping, m.actuator_surface_stiffness, m.actuator_piston_mass,
                                    m.actuator_surface_mass)),
      earth_damping_(2.0 * m.actuator_attachment_damping *
                     std::sqrt(m.actuator_earth_stiffness * m.actuator_body_mass)) {
  // The lines' creeping loss keeps their flow smooth through zero: a tenth of a percent of the stated flow.
  supply_line_.viscous = 1e-2 * m.supply_line_drop / m.supply_line_flow;
  return_line_.viscous = 1e-2 * m.supply_return_line_drop / m.supply_line_flow;
  set_wear(wear);
}

void Plant::set_wear(const Wear& wear) {
  wear_ = wear;
  // Screen: pores act side by side, so the flow of each rises as the open area falls.
  const double open = std::fmax(1.0 - wear.filter_blocked, 1e-3), q = m_.pilot_filter_flow;
  filter_ = {m_.pilot_filter_viscous_drop * thickness(m_, oil_) / (q * open),
             m_.pilot_filter_inertial_drop / (q * q * open * open)};
  // Silt stiffens presliding with the force it holds, so that the spool still lets go after the same few microns.
  spool_friction_ = {m_.spool_coulomb * wear.spool_friction,
                     m_.spool_breakaway * wear.spool_friction,
                     m_.spool_stribeck_speed,
                     m_.spool_bristle_stiffness * wear.spool_friction,
                     m_.spool_bristle_damping * std::sqrt(wear.spool_friction),
                     oil_.viscosity * pi * m_.spool_diameter * m_.spool_sheared_length / m_.ports_clearance};
  edge_ = Edge(m_, oil_, wear.edge_clearance);
  wire_ = m_.wire_stiffness * wear.wire_stiffness;
  const double null = m_.armature_null + m_.armature_null_drift * (temperature_ - zero_celsius - 40.0) + wear.null;
  null_mmf_ = m_.motor_turns * null * m_.driver_rated_current;
}

void Plant::rates(const State& s, const Inputs& in, const Hysteresis& hysteresis, double committed_flux, State& ds,
                  Flows& f) const {
  // 1 driver and torque motor
  ds[current] = driver_rate_ * (in.demand - s[current]);
  const double mmf = magnetics_.turns * wear_.torque_gain * s[current] + null_mmf_;
  const auto magnetic = magnetics_.at(mmf, s[flux], s[angle], hysteresis.mmf(s[flux] - committed_flux));
  ds[flux] = magnetic.flux_rate;

  // 2 screen, fixed orifices, nozzles
  const double x_flapper = m_.armature_nozzle_arm * s[angle];  // towards nozzle 1
  const double gap_1 = m_.pilot_nozzle_gap - x_flapper, gap_2 = m_.pilot_nozzle_gap + x_flapper;
  const double dp_nozzle_1 = s[p_pilot_1] - s[p_return], dp_nozzle_2 = s[p_pilot_2] - s[p_return];
  f.q_filter = flow_through(filter_, s[p_supply] - s[p_filter]);
  const double q_orifice_1 = flow_through(orifice_, s[p_filter] - s[p_pilot_1]);
  const double q_orifice_2 = flow_through(orifice_, s[p_filter] - s[p_pilot_2]);
  f.q_nozzle_1 = flow_through(nozzle_1_.at(gap_1), dp_nozzle_1);
  f.q_nozzle_2 = flow_through(nozzle_2_.at(gap_2), dp_nozzle_2);
  const double q_end_1 = end_leak_ * dp_nozzle_1, q_end_2 = end_leak_ * dp_nozzle_2;
  const double growth = spool_area_ * s[v_spool];
  ds[p_filter] = oil_.pressure_rate(s[p_filter], m_.pilot_filter_volume, 0.0, f.q_filter - q_orifice_1 - q_orifice_2);
  ds[p_pilot_1] = oil_.pressure_rate(s[p_pilot_1], m_.pilot_chamber_volume + spool_area_ * s[x_spool], growth,
                                     q_orifice_1 - f.q_nozzle_1 - q_end_1);
  ds[p_pilot_2] = oil_.pressure_rate(s[p_pilot_2], m_.pilot_chamber_volume - spool_area_ * s[x_spool], -growth,
                                     q_orifice_2 - f.q_nozzle_2 - q_end_2);

  // 3 armature: magnetic torque, flexure, wire, jets (pressure and momentum, Merritt 1967 eq. 6-69), stops
  f.wire_force = -wire_ * beyond_clearance(s[x_spool] + m_.armature_ball_arm * s[angle], wear_.wire_clearance);
  const double jet = 4.0 * m_.pilot_nozzle_discharge / m_.pilot_nozzle_diameter;
  const double jets = nozzle_area_ * (dp_nozzle_2 * (1.0 + jet * jet * gap_2 * gap_2) -
                                      dp_nozzle_1 * (1.0 + jet * jet * gap_1 * gap_1));
  const double stop =
      stop_force(x_flapper, m_.armature_nozzle_arm * s[angle_rate], m_.armature_stop, m_.armature_stop_stiffness, 2.0);
  ds[angle] = s[angle_rate];
  ds[angle_rate] = (magnetic.torque - m_.armature_flexure * s[angle] - m_.armature_damping * s[angle_rate] +
                    m_.armature_ball_arm * f.wire_force + m_.armature_nozzle_arm * (jets + stop)) /
                   m_.armature_inertia;

  // 4 four metering edges
  const double x = s[x_spool];
  const auto pa = edge_.flow(x - m_.ports_lap_pa, s[p_supply] - s[p_a]);
  const auto at = edge_.flow(-x - m_.ports_lap_at, s[p_a] - s[p_return]);
  const auto pb = edge_.flow(-x - m_.ports_lap_pb, s[p_supply] - s[p_b]);
  const auto bt = edge_.flow(x - m_.ports_lap_bt, s[p_b] - s[p_return]);
  f.q_pa = pa.q, f.q_at = at.q, f.q_pb = pb.q, f.q_bt = bt.q;
  f.q_a = pa.q - at.q;
  f.q_b = pb.q - bt.q;

  // 5 spool: steady flow force closes the edges that carry flow; transient force damps on the supply side
  const double steady = -jet_cosine_ * (std::fabs(pa.momentum) + std::fabs(bt.momentum) - std::fabs(at.momentum) -
                                        std::fabs(pb.momentum));
  const auto inertia = [&](const Edge::Flow& e) { return std::fabs(e.q) / e.gap * e.growth; };
  const double transient = -oil_.density * m_.spool_damping_length * s[v_spool] * (inertia(pa) + inertia(pb));
  f.flow_force = steady + transient;
  const auto rub = spool_friction_.at(s[v_spool], s[z_spool]);
  f.spool_friction = -rub.force;
  ds[x_spool] = s[v_spool];
  ds[v_spool] = (spool_area_ * (s[p_pilot_1] - s[p_pilot_2]) + f.wire_force + f.flow_force + f.spool_friction +
                 stop_force(x, s[v_spool], m_.spool_stop, m_.spool_stop_stiffness, 2.0)) /
                m_.spool_mass;
  ds[z_spool] = rub.rate;

  // 6 actuator chambers, piston, body and surface
  const double v_rod = s[v_piston] - s[v_body], x_rod = s[x_piston] - s[x_body];
  const double q_across = piston_leak_ * (s[p_a] - s[p_b]);
  ds[p_a] = oil_.pressure_rate(s[p_a], volume_a(s), piston_area_ * v_rod, f.q_a - q_across);
  ds[p_b] = oil_.pressure_rate(s[p_b], volume_b(s), -piston_area_ * v_rod, f.q_b + q_across);
  const auto seal = piston_friction_.at(v_rod, s[z_piston]);
  const double half = 0.5 * m_.actuator_stroke;
  const double into = std::fabs(x_rod) - (half - m_.actuator_cushion_length);
  const double cushion = into > 0.0 && x_rod * v_rod > 0.0
                             ? -m_.actuator_cushion_damping * into / m_.actuator_cushion_length * v_rod
                             : 0.0;
  f.piston_friction = -seal.force;
  const double on_piston = piston_area_ * (s[p_a] - s[p_b]) - seal.force + cushion +
                           stop_force(x_rod, v_rod, half, m_.actuator_stop_stiffness, 2.0);
  const double rod = m_.actuator_surface_stiffness * (s[x_piston] - s[x_surface]) +
                     surface_damping_ * (s[v_piston] - s[v_surface]);  // on the surface
  const double load = in.force + in.force_stiffness * s[x_surface];
  ds[z_piston] = seal.rate;
  ds[x_piston] = s[v_piston];
  ds[v_piston] = (on_piston - rod) / m_.actuator_piston_mass;
  ds[x_surface] = s[v_surface];
  ds[v_surface] = (rod - load) / m_.actuator_surface_mass;
  ds[x_body] = s[v_body];
  ds[v_body] =
      (-on_piston - m_.actuator_earth_stiffness * s[x_body] - earth_damping_ * s[v_body]) / m_.actuator_body_mass;

  // 7 supply and return
  f.q_supply = flow_through(supply_line_, s[p_accumulator] - s[p_supply]);
  f.q_return = flow_through(return_line_, s[p_return] - m_.supply_tank_pressure);
  ds[p_supply] = oil_.pressure_rate(s[p_supply], m_.supply_manifold_volume, 0.0, f.q_supply - f.q_filter - pa.q - pb.q);
  ds[p_return] = oil_.pressure_rate(s[p_return], m_.supply_manifold_volume, 0.0,
                                    at.q + bt.q + f.q_nozzle_1 + f.q_nozzle_2 + q_end_1 + q_end_2 - f.q_return);
  ds[p_accumulator] = (s[q_pump] - f.q_supply) / m_.supply_accumulator;
  const double wanted =
      std::clamp(m_.supply_pump_gain * (m_.supply_pressure - s[p_accumulator]), 0.0, m_.supply_pump_flow);
  ds[q_pump] = (wanted - s[q_pump]) / m_.supply_pump_lag;
  ds[oil_in] = f.q_supply;
  ds[oil_out] = f.q_return;
}

State Plant::rest() const {
  State s{};
  s[p_supply] = s[p_accumulator] = s[p_filter] = m_.supply_pressure;
  s[p_return] = m_.supply_tank_pressure;
  s[p_pilot_1] = s[p_pilot_2] = s[p_a] = s[p_b] = 0.5 * (m_.supply_pressure + m_.supply_tank_pressure);
  return s;
}

double Plant::volume_a(const State& s) const {
  return m_.actuator_dead_volume + piston_area_ * (0.5 * m_.actuator_stroke + (s[x_piston] - s[x_body]));
}
double Plant::volume_b(const State& s) const {
  return m_.actuator_dead_volume + piston_area_ * (0.5 * m_.actuator_stroke - (s[x_piston] - s[x_body]));
}

double Plant::stored_oil(const State& s) const {
  const double swept = spool_area_ * s[x_spool];
  return oil_.stored(s[p_supply], m_.supply_manifold_volume) + oil_.stored(s[p_return], m_.supply_manifold_volume) +
         oil_.stored(s[p_filter], m_.pilot_filter_volume) + oil_.stored(s[p_pilot_1], m_.pilot_chamber_volume + swept) +
         oil_.stored(s[p_pilot_2], m_.pilot_chamber_volume - swept) + oil_.stored(s[p_a], volume_a(s)) +
         oil_.stored(s[p_b], volume_b(s));
}

}  // namespace servodx::rig
