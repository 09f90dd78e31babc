// One foreign rig as it truly is, drawn from a seed, and what its user knows of it. Numbers are SI; laws that turn
// them into motion are in machine.h. Sizes follow from the rated flow, so that a valve of 4 l/min and one of 200 l/min
// are both likely machines; what a data sheet states differs from the truth by its tolerance.
#pragma once
#include <array>
#include <cstdint>

#include "oil.h"

namespace servodx::foreign {

enum Edge : int { edge_pa, edge_bt, edge_pb, edge_at, n_edges };

struct Amplifier {
  double bandwidth;  // [Hz]
  double gain;       // [1]
  double limit;      // [1] of rated current
};

struct FirstStage {
  double mass, stiffness, damping;  // [kg], [N/m], [N s/m] at the flapper's tip, without the wire
  double gap, stop, mismatch;       // [m] at rest, flapper's travel, difference of the two gaps over their mean [1]
  double nozzle, orifice;           // [m] diameters
  double nozzle_discharge, orifice_discharge, transition;  // [1], [1], [1] of the Reynolds-like number
  double arm;                                              // [1] travel of the ball over that of the tip
  double wire;                                             // [N/m] at the ball
  double torque;                                           // [N/A] at the tip
  double play;                                             // [m] whole clearance at the ball
  std::array<double, 2> loop, reach;   // [1] of rated current: half width of a magnetic loop, current that opens it
  double screen_drop, screen_laminar;  // [Pa] at the pilot's flow, [1] laminar part of it
  double pilot_flow;                   // [m3/s] of both sides at rest
  double screen_volume, chamber;       // [m3]
};

struct Spool {
  double diameter, stroke, stop, width;  // [m]; width of the ports along the circumference
  double mass, coulomb, stiction, stribeck, bristle, bristle_damping;  // [kg], [N], [N], [m/s], [N/m], [N s/m]
  double clearance, eccentricity, corner;                              // [m], [1] factor of leakage, [m]
  std::array<double, n_edges> lap;                                     // [m] positive: overlap
  double discharge, transition, sheared, jet, damping_length;          // [1], [1], [m], [1], [m]
};

struct Actuator {
  double area_a, area_b, stroke, mass;                   // [m2], [m2], [m], [kg]
  double coulomb, stiction, stribeck, bristle, viscous;  // [N], [N], [m/s], [N/m], [N s/m]
  double leak, dead_a, dead_b;                           // [m3/s/Pa], [m3], [m3]
  double body, mount, mount_damping;                     // [kg], [N/m] 0: rigid, [N s/m]
};

struct Lines {
  double length, bore, manifold, softness;  // [m], [m], [m3] at the valve, [1] of walls per chamber's own compliance
  bool taps_at_valve;
};

struct Supply {
  double pressure, tank;                      // [Pa]
  double pump_droop, pump_flow;               // [Pa s/m3], [m3/s] most
  double accumulator, inertance, loss;        // [m3/Pa], [kg/m4], [Pa s2/m6]
  double volume, return_volume, return_area;  // [m3], [m3], [m2]
};

struct Sensor {
  double gain, lag, noise, step;  // [1], [s], [SI] standard deviation, [SI] of the converter
};

enum Channel : int {
  ch_spool,
  ch_piston,
  ch_pressure_a,
  ch_pressure_b,
  ch_supply,
  ch_return,
  ch_load,
  ch_temperature,
  ch_coil,
  n_channels
};

struct Design {
  std::uint64_t seed;
  OilKind oil;
  double rated_current, rated_flow;  // [A], [m3/s] at 70 bar over both edges
  double valve_bandwidth;            // [Hz] crossover of the spool's loop
  double motor_frequency;            // [Hz]
  Amplifier amplifier;
  FirstStage first;
  Spool spool;
  Actuator actuator;
  Lines lines;
  Supply supply;
  double air, null;            // [1] usual free air, [1] of rated current
  double rate, control_rate;   // [Hz] of the log and of the generator and controller
  double position_gain;        // [1/s] of the position loop
  double no_load_flow, speed;  // [m3/s] at supply pressure, [m/s] extending
  std::array<Sensor, n_channels> sensors;
  std::array<bool, n_channels> recorded;
  bool command_recorded, percent, loaded;
  double acceptance_amplitude, acceptance_frequency;  // [1], [Hz]
  double step;                                        // [s] of integration
};

Design draw_design(std::uint64_t seed);

}  // namespace servodx::foreign
