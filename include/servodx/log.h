// A rig log in SI units, with what its reader noticed.
//
// The reader refuses what cannot be trusted (structure, units, order of time, too many gaps) and reads with a note what
// is merely implausible. It neither resamples nor filters nor corrects: jitter and gaps stay, missing samples are NaN.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "servodx/note.h"
#include "servodx/rig.h"

namespace servodx {

// The one list of the signals: the enum, names in a log's header, units, docs/reference.md and the Python module's keys
// are made of it. Positive command, positive spool travel, P to A and B to T open, the piston extends; A is the chamber
// that grows.
// clang-format off
// X(name, unit inside, dimension: signals/signal.h, meaning with its sign)
#define SERVODX_SIGNALS(X) \
  X(time,                "s",    time,        "time stamp; strictly increasing") \
  X(command,             "A",    current,     "current demand before amplifier and null offset; positive extends the piston") \
  X(coil_current,        "A",    current,     "measured coil current; where present it drives the model behind the driver") \
  X(setpoint,            "m",    length,      "position demand of a closed loop; never the model's input") \
  X(spool_position,      "m",    length,      "spool travel; positive opens P to A and B to T") \
  X(piston_position,     "m",    length,      "from mid-stroke, rod relative to body; positive extends (A grows)") \
  X(pressure_a,          "Pa",   pressure,    "chamber A, gauge") \
  X(pressure_b,          "Pa",   pressure,    "chamber B, gauge") \
  X(supply_pressure,     "Pa",   pressure,    "at the valve's P port, gauge") \
  X(return_pressure,     "Pa",   pressure,    "at the valve's T port, gauge") \
  X(pilot_pressure_1,    "Pa",   pressure,    "spool end that pushes towards positive travel, gauge") \
  X(pilot_pressure_2,    "Pa",   pressure,    "spool end that pushes towards negative travel, gauge") \
  X(load_pressure,       "Pa",   pressure,    "pressure_a - pressure_b") \
  X(valve_pressure_drop, "Pa",   pressure,    "total over both metering edges") \
  X(load_force,          "N",    force,       "external force; positive opposes extension") \
  X(flow_a,              "m3/s", flow,        "positive out of the valve into port A") \
  X(flow_b,              "m3/s", flow,        "positive out of the valve into port B") \
  X(control_flow,        "m3/s", flow,        "through the load, A to B; positive at positive command") \
  X(leakage_flow,        "m3/s", flow,        "supply to return, load ports blocked") \
  X(oil_temperature,     "K",    temperature, "oil at the valve")
// clang-format on

enum class Signal : int {
#define X(name, unit, dimension, meaning) name,
  SERVODX_SIGNALS(X)
#undef X
};
#define X(name, unit, dimension, meaning) +1
inline constexpr int n_signals = 0 SERVODX_SIGNALS(X);
#undef X
constexpr int index(Signal s) { return static_cast<int>(s); }
std::optional<Signal> find_signal(std::string_view name);
std::string_view name_of(Signal s);  // "spool_position"

struct Channel {
  std::vector<double> value;  // [SI] one a sample; NaN where the sample is missing. Empty: the log lacks this signal
  std::string unit;           // unit of the header cell, for writing back; for volts the unit after the gain
  double full_scale = 0.0;    // [SI] what 100 % stands for where `unit` is '% of ...'; else 0
  double resolution = 0.0;    // [SI] smallest step between distinct values; 0 unknown
  std::string column;         // the column's name in the file
  std::size_t missing = 0;    // samples left out (NaN)
};

struct Log {
  std::string path;
  std::string sha256;                       // of the file's bytes, hex
  std::vector<double> time;                 // [s] strictly increasing, as recorded (jitter and gaps kept)
  std::array<Channel, n_signals> channels;  // index(Signal); the `time` slot holds only the unit
  std::vector<Note> notes;                  // what is not as one would expect

  bool has(Signal s) const { return !channels[index(s)].value.empty(); }
  const std::vector<double>& operator[](Signal s) const { return channels[index(s)].value; }
  std::size_t samples() const { return time.size(); }
};

struct ReadOptions {
  std::size_t minimum_rows = 20;
  bool require_response = true;  // at least one of spool, piston, both chamber pressures, load pressure or a flow
  bool require_drive = true;     // command or coil_current

  // Throws InputError that names the option.
  void validate() const;
};

// Largest part of a signal's samples that may be missing.
inline constexpr double missing_limit = 0.05;

// Reads a CSV log by the rules of docs/logs.md. Throws InputError (file, line, column, rule, mend); nothing is returned
// half-read.
Log read_log(const std::string& path, const RigFile& rig = {}, const ReadOptions& options = {});

// A column in memory: its name as a header cell has it, "pressure_a [bar]", or one that the rig file maps.
struct LogColumn {
  std::string name;
  std::vector<double> values;  // [the unit in the name] one a sample; NaN where the sample is missing
};

// The same from memory, by the same rules. `name` stands for the file in errors and results.
Log make_log(const std::string& name, const std::vector<LogColumn>& columns, const RigFile& rig = {},
             const ReadOptions& options = {});

// Hash of what the log says, signals and time: independent of its path, of comments, of the order of columns and of how
// numbers are written. The same for a log in memory.
std::string content_hash(const Log& log);

struct OutputColumn {
  Signal signal;
  std::string unit;           // written in the header, "name [unit]"
  std::vector<double> value;  // [SI]; NaN is written as an empty cell
  double full_scale = 0.0;    // [SI] of 100 % where `unit` is '% of ...'
};

// `values` as a column in the log's own unit of that signal (the SI unit where the log lacks it).
OutputColumn output_column(const Log& log, Signal signal, std::vector<double> values);

// The time and every signal of the log, in the log's own units.
std::vector<OutputColumn> columns_of(const Log& log);

// Writes a canonical CSV (shortest round-trip digits) to a temporary name and renames it. A value that was read from a
// log reads back to the same bits in that log's unit; any value does in an SI unit.
void write_log(const std::string& path, const std::vector<OutputColumn>& columns,
               const std::vector<std::string>& comments = {});

}  // namespace servodx
