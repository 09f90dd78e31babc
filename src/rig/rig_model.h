// What one virtual rig is made of: every number of params/rigs/*.toml, SI, checked once and whole when it is read.
// The list, with units, bounds and meanings, is parameters.inc; the values with their reasons are in the TOML files.
// A file may name another as its `base` and give only what differs.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "servodx/rig.h"

namespace servodx::rig {

enum class FirstStage { flapper_nozzle, jet_pipe };
enum class CoilWiring { series, parallel, single };  // of the two coils

// A measuring chain: y = gain * lag(x) + offset + pick-up + noise, then rounded to the quantum.
struct Sensor {
  std::string signal;    // canonical signal name
  std::string unit;      // unit of the log column
  double gain = 1.0;     // [1]
  double offset = 0.0;   // [SI of the signal]
  double lag = 0.0;      // [s] first order
  double noise = 0.0;    // [SI of the signal] rms, white
  double pickup = 0.0;   // [SI of the signal] amplitude at mains frequency
  double quantum = 0.0;  // [column unit] 0: not quantised
};

struct RigModel {
  std::string path;
  std::string name;
  FirstStage first_stage = FirstStage::flapper_nozzle;
  CoilWiring coil_wiring = CoilWiring::series;
  Ports ports = Ports::actuator;
#define RIG_PARAMETER(group, name, unit, low, high, meaning) double group##_##name = 0.0;
#include "rig/parameters.inc"
#undef RIG_PARAMETER
  std::vector<double> spread;        // [SI] of each parameter, in the order of rig_parameters(); 0: all valves alike
  std::vector<Sensor> sensors;       // in the order of the log's columns
  std::vector<std::string> changed;  // "group.name=value" set after reading

  double piston_area_a() const;   // [m2]
  double piston_area_b() const;   // [m2]
  double spool_area() const;      // [m2]
  double working_turns() const;   // [1] ampere turns per ampere of the driver
  double circuit_factor() const;  // [1] resistance and leakage inductance of the wired coils over those of one
  bool has_actuator() const { return ports == Ports::actuator; }
};

struct ParameterInfo {
  const char* group;
  const char* name;
  const char* unit;
  double low, high;
  const char* meaning;
  double RigModel::*field;
};
const std::vector<ParameterInfo>& rig_parameters();

// Throws InputError with file, line and key: a missing or unknown key, a wrong unit, a value out of bounds, no reason.
RigModel read_rig_model(const std::string& path);

// "group.name=value" in SI, "sensors.SIGNAL.KEY=value", or first_stage, coil_wiring, ports =word. Throws InputError.
void set_value(RigModel& model, const std::string& text);

// Another valve of the same type: every parameter with a spread is drawn anew, normal, cut at twice the spread and at
// the parameter's bounds. Seed 0 is the definition itself.
RigModel another_valve(const RigModel& model, std::uint64_t seed);

}  // namespace servodx::rig
