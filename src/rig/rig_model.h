// What one virtual rig is made of: every number of params/rigs/*.toml, SI, checked once and whole when it is read.
// The list, with units, bounds and meanings, is parameters.inc; the values with their reasons are in the TOML file.
#pragma once
#include <string>
#include <vector>

namespace servodx::rig {

// A measuring chain: y = gain * lag(x) + offset + noise, then rounded to the quantum.
struct Sensor {
  std::string signal;    // canonical signal name
  std::string unit;      // unit of the log column
  double gain = 1.0;     // [1]
  double offset = 0.0;   // [SI of the signal]
  double lag = 0.0;      // [s] first order
  double noise = 0.0;    // [SI of the signal] rms, white
  double quantum = 0.0;  // [column unit] 0: not quantised
};

struct RigModel {
  std::string path;
  std::string name;
#define RIG_PARAMETER(group, name, unit, low, high, meaning) double group##_##name = 0.0;
#include "rig/parameters.inc"
#undef RIG_PARAMETER
  std::vector<Sensor> sensors;  // in the order of the log's columns

  double piston_area() const;  // [m2]
  double spool_area() const;   // [m2]
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

}  // namespace servodx::rig
