// What the data sheet of a valve and its rig says: rig.toml, its facts and the mapping of columns.
//
// Every key is optional; an unknown key is an error. Quantities are strings with a unit ("20 mA"); they are kept in SI
// under their dotted key. Derived here and nowhere else: the actuator areas from bore and rods, and the fluid from its
// preset. What a fact means for the parameter table is decided where the table is.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace servodx {

enum class Ports { actuator, blocked, free };
enum class Taps { not_said, at_valve, at_cylinder };
enum class CommandHold { zero, linear };

// value [SI] = gain * x + offset, where x is the column's number in SI of its own unit (volts for "V").
struct ColumnMapping {
  std::string signal;       // canonical name
  std::string column_unit;  // unit of the column's numbers ("V"); empty: the header cell says it
  std::string unit;         // unit of the signal after the gain ("mm" for "20 mm/V"); empty for a plain-number gain
  double gain = 1.0;        // [SI of the signal per SI of column_unit]
  double offset = 0.0;      // [SI]
  bool gain_has_unit = false;
  long line = 0;
};

struct Fluid {
  double density = 860.0;              // [kg/m3] at 20 degC
  double kinematic_viscosity = 14e-6;  // [m2/s] at 40 degC
  double kinematic_viscosity_100 = 0;  // [m2/s] at 100 degC; 0: not said
  bool given = false;                  // true where the rig file says a fluid
  std::string name;                    // preset name, if one
};

// A limit of the acceptance sheet ([limits], 'servodx curves'): "4 %" bounds the figure on its usual side, a table
// { min = "...", max = "..." } on either. Of a figure with a sign its size is judged.
struct Limit {
  std::optional<double> min, max;  // [SI]
};

// A point of the frequency response that the sheet states ([[valve.frequency_response]]): the spool, or the flow
// without load, against a sine of the current. At least one of gain and lag is stated.
struct ResponseFact {
  double frequency = 0;             // [Hz]
  double amplitude = 0.4;           // [fraction of rated current] of the sine, peak: catalogues' usual +-40 %
  std::optional<double> gain;       // [dB] over the gain at low frequency
  std::optional<double> phase_lag;  // [rad]
};

// Facts in SI; empty where the file is silent.
struct RigFile {
  std::string path;
  std::string sha256;
  std::string name, serial;
  Ports ports = Ports::actuator;
  std::optional<CommandHold> command_hold;  // empty: the file is silent (the default hold is zero)
  std::optional<double> mains_frequency;    // [Hz]
  double null_limit = 0.05;                 // [fraction of rated current]
  std::optional<double> oil_temperature;    // [K] of logs that do not record it
  Taps taps = Taps::not_said;               // where the chambers' pressures are measured
  Fluid fluid;
  // facts by dotted key, SI: "valve.rated_current" [A], "valve.spool_stroke" [m], "actuator.area_a" [m2],
  // "supply.pressure" [Pa], ...; rig_facts() lists them all
  std::map<std::string, double> facts;
  std::vector<ResponseFact> response;        // as listed
  std::map<std::string, Limit> limits;       // by figure
  std::map<std::string, std::string> words;  // string facts: "valve.first_stage"
  std::map<std::string, long> lines;         // line of each key given, for errors
  std::map<std::string, ColumnMapping> columns;
  std::vector<long> open_questions;  // lines of columns that 'init' asked about and nobody has answered

  std::optional<double> fact(const std::string& key) const {
    auto it = facts.find(key);
    return it == facts.end() ? std::nullopt : std::optional<double>(it->second);
  }
  long line(const std::string& key) const {
    auto it = lines.find(key);
    return it == lines.end() ? 0 : it->second;
  }
};

// Throws InputError with file, line and key.
RigFile read_rig_file(const std::string& path);
// The same from memory: `text` is what a rig.toml holds; `name` stands for the file in errors and results.
RigFile make_rig(const std::string& name, const std::string& text);
using Rig = RigFile;

}  // namespace servodx
