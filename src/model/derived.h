// What a candidate's rows and a log's oil fix for the whole run, computed once a run.
#pragma once
#include <cmath>

#include "model/asperities.h"
#include "model/constants.h"
#include "model/hooks.h"
#include "model/state.h"
#include "parameters/list.h"

namespace servodx {

// The numbers that the equations read. X(name, unit, meaning)
// clang-format off
#define SERVODX_DERIVED(X) \
  /* first stage */ \
  X(driver_rate,               "1/s",          "") \
  X(flapper_rate2,             "1/s2/(N/m)",   "natural frequency squared over stiffness") \
  X(flapper_damping,           "1/s",          "") \
  X(nozzle_area,               "m2",           "facing the flapper") \
  X(nozzle_1_share,            "-",            "open of nozzle 1's gap") \
  X(nozzle_2_share,            "-",            "open of nozzle 2's gap") \
  X(nozzle_conductance,        "m3/s/sqrt(Pa)/m", "per curtain opening") \
  X(bore_loss,                 "1/m2",         "pressure lost in a nozzle's bore over that at its curtain, per opening squared") \
  X(nozzle_creep,              "m2 sqrt(Pa)",  "half the laminar drop of a nozzle's land over the root of the turbulent one, times opening squared") \
  X(orifice_conductance,       "m3/s/sqrt(Pa)", "") \
  X(orifice_creep,             "sqrt(Pa)",     "half the laminar drop of a fixed orifice over the root of the turbulent one") \
  X(filter_conductance,        "m3/s/sqrt(Pa)", "mean of both directions of the spool") \
  X(filter_one_way,            "m3/s/sqrt(Pa)", "less while the spool moves positive, more while it moves negative") \
  X(filter_creep,              "sqrt(Pa)",     "half the laminar drop of the clean filter over the root of its turbulent one") \
  X(half_backlash,             "m",            "between wire and spool") \
  X(inverse_filter_compliance, "Pa/m3",        "") \
  X(inverse_pilot_compliance,  "Pa/m3",        "") \
  /* second stage */ \
  X(spool_area,                "m2",           "") \
  X(inverse_spool_mass,        "1/kg",         "") \
  X(spool_viscous,             "N s/m",        "shear in the annulus") \
  X(spool_presliding,          "m",            "way over which the spool's dry friction is taken up") \
  X(per_spool_presliding,      "1/m",          "") \
  X(flow_force,                "kg/m2",        "times an edge's flow and half its speed over the port's width") \
  X(width,                     "m",            "of the ports") \
  X(clearance2,                "m2",           "of twice the radial clearance") \
  X(slot_per_length,           "Pa s/m",       "laminar resistance of a covered edge per length, times width, opening squared and 1 + a, a the abruptness") \
  X(slot_corner,               "Pa s",         "twice the same of the corner of an open edge") \
  X(supply_edge,               "m",            "corner radius of the metering edges from supply") \
  X(return_edge,               "m",            "and of those to return") \
  X(viscosity_rise,            "1/Pa",         "of the oil in the metering edges with pressure") \
  X(edge_loss,                 "Pa s2/m4",     "4 rho / (2 Cd^2)") \
  X(hose_loss,                 "Pa s2/m4",     "hose_resistance width^2, per twice the opening squared") \
  X(return_loss,               "Pa s2/m4",     "the same with the return line") \
  X(creep_added,               "-",            "share of the two resistances above that adds to the root: (1 - a) / (1 + a)") \
  X(creep_fading,              "-",            "fading of an open edge's laminar drop times (1 + a)^2 / 4") \
  /* actuator */ \
  X(leak,                      "m3/s/Pa",      "") \
  X(viscous,                   "N s/m",        "") \
  X(inverse_mass,              "1/kg",         "") \
  X(half_stroke,               "m",            "") \
  X(middle_volume_a,           "m3",           "at mid-stroke") \
  X(middle_volume_b,           "m3",           "at mid-stroke") \
  X(inverse_bulk,              "1/Pa",         "") \
  X(stiffening,                "1/Pa",         "relative rise of the bulk modulus with pressure") \
  X(air,                       "Pa",           "free air fraction times atmospheric pressure") \
  X(viscosity_ratio,           "-",            "of the oil over that at 40 degC")
// clang-format on

enum DerivedNumber : int {
#define X(name, unit, meaning) number_##name,
  SERVODX_DERIVED(X)
#undef X
      n_derived
};

template <class T>
struct Derived {
  using Scalar = T;
#define X(name, unit, meaning) T name;
  SERVODX_DERIVED(X)
#undef X
  T inverse_flapper_stiffness;  // [m/N]
  Breakaway<T> breakaway;
};

// p: a candidate in SI.
template <class T, class Effects = EffectList<>>
Derived<T> derive(const T* p, const Oil& oil) {
  using std::sqrt;
  namespace c = constants;
  Derived<T> d;
  const T factor = hook_viscosity(p, oil, Effects{});
  const T dynamic_viscosity = factor * T(oil.dynamic_viscosity), viscosity_ratio = factor * T(oil.viscosity_ratio);
  d.viscosity_ratio = viscosity_ratio;
  const T per_root_density = T(std::sqrt(2.0 / oil.density)), omega = T(2.0 * c::pi) * p[row::torque_motor_frequency];
  d.driver_rate = T(2.0 * c::pi) * p[row::driver_bandwidth];
  d.inverse_flapper_stiffness = T(1.0) / p[row::flapper_stiffness];
  d.flapper_rate2 = omega * omega * d.inverse_flapper_stiffness;
  d.flapper_damping = T(2.0 * c::flapper_damping_ratio) * omega;
  const T nozzle_diameter = p[row::hydraulic_amplifier_gain] * T(1.0 / c::pi);
  d.nozzle_area = T(c::pi / 4.0) * nozzle_diameter * nozzle_diameter;
  d.nozzle_1_share = T(1.0) + hook_nozzle_1_share(p, Effects{});
  d.nozzle_2_share = T(1.0) + hook_nozzle_2_share(p, Effects{});
  d.nozzle_conductance = T(c::cd_nozzle) * per_root_density * p[row::hydraulic_amplifier_gain];
  // Bernoulli: the bore's velocity is 4 Cd opening / diameter times the curtain's.
  const T bore_speed = T(4.0 * c::cd_nozzle) / nozzle_diameter;
  d.bore_loss = T(c::nozzle_bore_loss) * bore_speed * bore_speed;
  // Plane slot, 12 mu w q / (pi (d + w) y^3), in series with the jet's head.
  const T land = hook_nozzle_land(p, Effects{});
  d.nozzle_creep = T(6.0 / c::pi) * dynamic_viscosity * land * d.nozzle_conductance / (nozzle_diameter + land);
  const T orifice_area = T(c::pi / 4.0) * p[row::fixed_orifice_diameter] * p[row::fixed_orifice_diameter];
  d.orifice_conductance = T(c::cd_orifice) * per_root_density * orifice_area;
  // Hagen-Poiseuille, 128 mu L q / (pi D^4), in series with the jet's head.
  const T cube = p[row::fixed_orifice_diameter] * p[row::fixed_orifice_diameter] * p[row::fixed_orifice_diameter];
  d.orifice_creep =
      hook_orifice_length(p, Effects{}) * T(64.0 / c::pi) * dynamic_viscosity * d.orifice_conductance / cube;
  const T clean = d.orifice_conductance * T(2.0 * c::clean_filter_area_ratio);
  d.filter_conductance =
      clean * (T(1.0) - T(0.5) * (p[row::filter_blockage_positive] + p[row::filter_blockage_negative]));
  d.filter_one_way = clean * (T(0.5) * (p[row::filter_blockage_positive] - p[row::filter_blockage_negative]));
  // At rest the orifices lose about half of the supply, and the filter that over its areas' ratio squared.
  d.filter_creep = hook_screen_drop(p, Effects{}) * viscosity_ratio * T(0.5 * c::clean_filter_area_ratio) /
                   sqrt(T(0.5) * p[row::supply_pressure]);
  d.half_backlash = p[row::valve_glitch] * T(0.5);
  const T bulk_modulus = p[row::bulk_modulus] * T(oil.stiffness_ratio);
  d.inverse_filter_compliance = bulk_modulus * T(1.0 / c::filter_node_volume);
  d.spool_area = T(c::pi / 4.0) * p[row::spool_diameter] * p[row::spool_diameter];
  d.inverse_pilot_compliance = bulk_modulus / (d.spool_area * p[row::spool_stop] * T(c::pilot_volume_in_stops));
  const T spool_length = p[row::spool_diameter] * T(c::spool_length_in_diameters);
  d.inverse_spool_mass = T(1.0) / (T(c::steel_density) * d.spool_area * spool_length);
  d.spool_viscous = T(c::pi) * dynamic_viscosity * p[row::spool_diameter] * spool_length / p[row::radial_clearance];
  d.spool_presliding = T(c::spool_presliding) + hook_spool_yield(p, Effects{});
  d.per_spool_presliding = T(1.0) / d.spool_presliding;
  d.width = p[row::port_width], d.clearance2 = T(4.0) * p[row::radial_clearance] * p[row::radial_clearance];
  // Plane Couette slot: dp = 12 mu L q / (w c^3); an open edge has a creeping-flow length of some openings.
  const T abrupt = hook_edge_abruptness(p, Effects{}), beside = T(1.0) + abrupt;
  d.creep_added = (T(1.0) - abrupt) / beside;
  d.creep_fading = T(0.25) * hook_edge_fading(p, Effects{}) * beside * beside;
  const T slot = T(12.0) * dynamic_viscosity * beside;
  d.slot_per_length = slot / p[row::radial_clearance];
  d.slot_corner = T(2.0) * slot * (T(c::slot_resistance) + hook_edge_creep(p, Effects{}));
  d.supply_edge = T(c::edge_rounding) + hook_edge_rounding(p, false, Effects{});
  d.return_edge = T(c::edge_rounding) + hook_edge_rounding(p, true, Effects{});
  d.viscosity_rise = hook_viscosity_rise(p, Effects{});
  d.edge_loss = T(4.0 * oil.density / (2.0 * c::cd_metering * c::cd_metering));
  d.flow_force = T(0.5 * c::jet_angle_factor) * p[row::flow_force_coefficient] * d.width * d.edge_loss;
  d.hose_loss = p[row::hose_resistance] * d.width * d.width;
  const T per_stroke2 = T(0.25) / (p[row::spool_stop] * p[row::spool_stop]);
  d.return_loss = d.hose_loss + hook_return_share(p, Effects{}) * d.edge_loss * per_stroke2;
  d.leak = p[row::cross_piston_leakage] * (T(1.0) / viscosity_ratio);
  const T sheared = hook_seal_shear(p, Effects{}), dry = hook_seal_dry(p, Effects{});
  const T film = sqrt(viscosity_ratio);  // seals ride on a film of their own
  d.viscous = p[row::piston_viscous_friction] * ((T(1.0) - sheared - dry) * film + sheared * viscosity_ratio + dry);
  d.breakaway.per_film_speed = T(1.0) / (T(c::piston_stribeck_velocity) + hook_seal_film_speed(p, Effects{}));
  // A tenth of itself and a newton keep the ratio bounded where seals hardly drag.
  d.breakaway.over_sliding =
      p[row::piston_stribeck_friction] /
      (p[row::piston_coulomb_friction] + T(0.1) * p[row::piston_stribeck_friction] + T(c::least_friction));
  d.inverse_mass = T(1.0) / p[row::moving_mass];
  d.half_stroke = T(0.5) * p[row::piston_stroke];
  d.middle_volume_a = p[row::dead_volume_a] + p[row::piston_area_a] * d.half_stroke;
  d.middle_volume_b = p[row::dead_volume_b] + p[row::piston_area_b] * d.half_stroke;
  d.inverse_bulk = T(1.0) / bulk_modulus, d.stiffening = hook_stiffness_rise(p, Effects{}) * d.inverse_bulk;
  d.air = p[row::air_fraction] * T(c::atmospheric_pressure);
  return d;
}

}  // namespace servodx
