// rig.toml: datasheet facts and column mapping. Every key is optional; an unknown key is an error.
#pragma once
#include <map>
#include <optional>
#include <string>

namespace servodx {

enum class Ports { actuator, blocked, free };
enum class CommandHold { zero, linear };

struct ColumnMapping {
  std::string signal;            // canonical name
  std::string unit;              // unit of the column's numbers after `gain` (e.g. "mm" for "20 mm/V")
  double gain = 1.0;             // [SI of the signal per column unit] value_si = gain * x + offset
  double offset = 0.0;           // [SI]
};

struct Fluid {
  double density = 860.0;                // [kg/m3] at 20 degC
  double kinematic_viscosity = 14e-6;    // [m2/s] at 40 degC
  bool given = false;                    // true where the rig file says a fluid
  std::string name;                      // preset name, if one
};

// Facts in SI; empty where the file is silent.
struct RigFile {
  std::string path;
  std::string sha256;
  std::string name, serial;
  Ports ports = Ports::actuator;
  std::optional<CommandHold> command_hold;   // empty: the file is silent (the default hold is zero)
  std::optional<double> mains_frequency;     // [Hz]
  double null_limit = 0.05;                  // [fraction of rated current]
  Fluid fluid;
  // facts by dotted key, SI: "valve.rated_current" [A], "valve.spool_stroke" [m], "actuator.area_a" [m2], "supply.pressure" [Pa], ...
  std::map<std::string, double> facts;
  std::map<std::string, std::string> words;  // string facts: "valve.first_stage"
  std::map<std::string, long> lines;         // line of each fact, for errors
  std::map<std::string, ColumnMapping> columns;

  std::optional<double> fact(const std::string& key) const {
    auto it = facts.find(key);
    return it == facts.end() ? std::nullopt : std::optional<double>(it->second);
  }
};

// Throws InputError with file, line and key.
RigFile read_rig_file(const std::string& path);

}  // namespace servodx
