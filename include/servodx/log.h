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

// Positive command, positive spool travel, P to A and B to T open, the piston extends; A is the chamber that grows.
enum class Signal : int {
  time,
  command,
  coil_current,
  setpoint,
  spool_position,
  piston_position,
  pressure_a,
  pressure_b,
  supply_pressure,
  return_pressure,
  pilot_pressure_1,
  pilot_pressure_2,
  load_pressure,
  valve_pressure_drop,
  load_force,
  flow_a,
  flow_b,
  control_flow,
  leakage_flow,
  oil_temperature,
};
inline constexpr int n_signals = 20;
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
