#include "faults.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace servodx::foreign {
namespace {

constexpr std::string_view leakage = "cylinder_internal_leakage";

double leak_unit(const Design& d) { return d.rated_flow / d.supply.pressure; }  // [m3/s/Pa]

// Stiffness [N/m] of the oil on both sides of the piston at mid-stroke.
double oil_spring(const Design& d) {
  const Actuator& a = d.actuator;
  const auto side = [&](double area, double dead) {
    return d.oil.stiffness * area * area / (0.5 * area * a.stroke + dead);
  };
  return side(a.area_a, a.dead_a) + side(a.area_b, a.dead_b);
}

double chamber_compliance(const Design& d) {
  return (0.5 * d.actuator.area_a * d.actuator.stroke + d.actuator.dead_a) / d.oil.stiffness;
}

}  // namespace

const std::vector<Fault>& faults() {
  static const std::vector<Fault> all = {
      {"clogged_filter", 0.25, 0.50, 0.75, [](Condition& c, const Design&, double s) { c.blocked_screen = s; }},
      {"torque_motor_loss", 0.8, 0.5, 0.2, [](Condition& c, const Design&, double s) { c.torque = s; }},
      {"feedback_wire_backlash", 5e-6, 10e-6, 20e-6, [](Condition& c, const Design&, double s) { c.play = s; }},
      {"feedback_wire_lost", 0.5, 0.2, 0.0, [](Condition& c, const Design&, double s) { c.wire = s; }},
      {"sticky_spool", 4, 10, 20, [](Condition& c, const Design&, double s) { c.spool_friction = s; }},
      {"radial_clearance_wear", 3, 6, 10, [](Condition& c, const Design&, double s) { c.clearance = s; }},
      {"null_shift", 0.06, 0.12, 0.20, [](Condition& c, const Design&, double s) { c.null += s; }},
      {"plugged_nozzle", 0.08, 0.2, 0.95, [](Condition& c, const Design&, double s) { c.blocked_nozzle = s; }},
      // per rated flow and supply pressure: what passes at full load pressure
      {std::string(leakage), 0.018, 0.053, 0.14,
       [](Condition& c, const Design& d, double s) { c.leak = s * leak_unit(d); }},
      {"sensor_gain_drift_position", 0.96, 0.9, 0.8,
       [](Condition& c, const Design&, double s) { c.position_gain = s; }},
      {"supply_pressure_sag", 0.88, 0.75, 0.55, [](Condition& c, const Design&, double s) { c.supply = s; }},
  };
  return all;
}

const std::vector<Electric>& electrics() {
  static const std::vector<Electric> all = {
      {"driver_fault", "", 0.0, [](Condition& c) { c.driver = 0.0; }},
      {"driver_fault", "", 0.5, [](Condition& c) { c.driver = 0.5; }},
      {"driver_fault", "", 0.85, [](Condition& c) { c.driver = 0.85; }},
      {"driver_fault", "", 0.3, [](Condition& c) { c.driver_limit = 0.3; }},
      {"sensor_fault", "pressure_a", 0.0, [](Condition& c) { c.sensor = ch_pressure_a, c.frozen = true; }},
      {"sensor_fault", "piston_position", 0.0, [](Condition& c) { c.sensor = ch_piston, c.frozen = true; }},
      {"sensor_fault", "pressure_b", 8.0, [](Condition& c) { c.sensor = ch_pressure_b, c.noise = 8.0; }},
      {"sensor_fault", "piston_position", 8.0, [](Condition& c) { c.sensor = ch_piston, c.noise = 8.0; }},
  };
  return all;
}

double severity_value(const Fault& fault, const Design& d, double severity) {
  return fault.name == leakage ? severity * leak_unit(d) : severity;
}

const std::vector<Effect>& effects() {
  static const std::vector<Effect> all = {
      {"transport_delay",
       [](Condition& c, const Design&, double share, Random& r) { return c.delay = share * r.uniform(1e-3, 3e-3); }},
      {"hose_compliance", [](Condition& c, const Design& d, double share,
                             Random& r) { return c.hose = share * r.uniform(0.8, 2.0) * chamber_compliance(d); }},
      {"air_entrainment",
       [](Condition& c, const Design&, double share, Random& r) { return c.air = share * r.uniform(0.02, 0.08); }},
      {"asymmetric_lap",
       [](Condition& c, const Design& d, double share, Random& r) {
         const auto edge = r.below(n_edges);
         const double sign = r.uniform() < 0.5 ? -1.0 : 1.0;
         return c.lap[edge] = sign * share * r.uniform(0.03, 0.06) * d.spool.stroke;
       }},
      {"sensor_lag", [](Condition& c, const Design&, double share,
                        Random& r) { return c.position_lag = share * r.uniform(2e-3, 5e-3); }},
      {"mains_pickup",
       [](Condition& c, const Design&, double share, Random& r) { return c.pickup = share * r.uniform(8.0, 15.0); }},
      {"mount_compliance", [](Condition& c, const Design& d, double share,
                              Random& r) { return c.mount = oil_spring(d) * r.uniform(0.5, 1.2) / share; }},
      {"cross_piston_leakage", [](Condition& c, const Design& d, double share,
                                  Random& r) { return c.leak = share * r.uniform(0.06, 0.14) * leak_unit(d); }},
      {"stiction", [](Condition& c, const Design& d, double share,
                      Random& r) { return c.stiction = share * r.uniform(4.0, 8.0) * d.spool.coulomb; }},
      {"magnetic_hysteresis", [](Condition& c, const Design&, double share,
                                 Random& r) { return c.hysteresis = 1.0 + share * r.uniform(2.0, 4.0); }},
      {"flow_force", [](Condition& c, const Design&, double share,
                        Random& r) { return c.flow_force = 1.0 + share * r.uniform(1.0, 2.0); }},
      {"viscosity_change",
       [](Condition& c, const Design&, double share, Random& r) {
         const double whole = r.uniform() < 0.5 ? r.uniform(2.0, 3.0) : r.uniform(0.3, 0.5);
         return c.viscosity = std::pow(whole, share);
       }},
  };
  return all;
}

Condition draw_condition(const Design& d, Random& r, bool wide) {
  Condition c;
  if (wide)
    c.celsius = d.oil.flight ? r.uniform(-20.0, 70.0) : r.uniform(15.0, 60.0);
  else
    c.celsius = r.uniform(28.0, 50.0);
  c.air = std::clamp(d.air * r.uniform(0.6, 1.6), 0.002, 0.015);
  c.null = r.uniform(-0.01, 0.01);
  return c;
}

}  // namespace servodx::foreign
