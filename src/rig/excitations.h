// What drives a rig: a demand and a load against time, from a registry of named excitations. All random from a seed.
//
// Open-loop excitations add a slow centring term -0.05 mA/mm times the measured piston position to the current, so
// that null and lap do not carry the piston to its stop (loop time about 1.3 s); the logged command includes it.
// `flight` follows Borello et al. 2009, sec. 7: proportional position loop, steps of random size, length (up to 2 s)
// and interval (up to 20 s, shortened in short logs), load k x plus turbulence of up to 20 % of the stall force. Its
// load spring acts on the surface's position, where the paper's is taken at the command.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "rig/rig_model.h"

namespace servodx::rig {

struct Load {
  double force = 0.0;      // [N] positive opposes extension
  double stiffness = 0.0;  // [N/m] spring to mid-stroke
};

struct Stimulus {
  // Called once a control tick with the time and the measured piston position; returns the current demand [A].
  std::function<double(double time, double position)> command;
  std::function<double(double time)> setpoint;  // [m] empty in open loop
  std::function<Load(double time)> load;        // empty: no load
  bool compensated = false;  // the current that holds the actuator at rest before the test is added throughout
};

struct Shape {
  double duration = 5.0;   // [s]
  double amplitude = 0.0;  // [1] of rated current (flight: of half the stroke); 0: the excitation's own
  double frequency = 0.0;  // [Hz] sine, triangle, preflight; 0: the excitation's own
  std::uint64_t seed = 1;
};

struct ExcitationInfo {
  std::string name;
  std::string description;
  std::function<Stimulus(const RigModel&, const Shape&)> make;
};
const std::vector<ExcitationInfo>& excitations();

// Null offset over time [1 of rated current] in flight (Borello et al. 2009, eq. 5): 2 % constant, steps of up to 3 %
// that last up to 2 s, one within every 10 s, and ramps of up to 5 % over up to a minute.
std::function<double(double time)> borello_offset(std::uint64_t seed, double duration);

// Throws InputError for an unknown name, with the list of names.
Stimulus make_stimulus(const std::string& name, const RigModel& model, const Shape& shape);

}  // namespace servodx::rig
