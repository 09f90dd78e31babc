// A rig log in SI units, with what its reader noticed.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "signals/rig_file.h"
#include "signals/signal.h"

namespace servodx {

struct Channel {
  std::vector<double> value;  // [SI] one a sample; NaN where the sample is missing. Empty: the log lacks this signal
  std::string unit;           // unit of the header cell, for writing back
  double resolution = 0.0;    // [SI] smallest step between distinct values; 0 unknown
};

struct Log {
  std::string path;
  std::string sha256;                       // of the file's bytes, hex
  std::vector<double> time;                 // [s] strictly increasing, as recorded (jitter and gaps kept)
  std::array<Channel, n_signals> channels;  // index(Signal); the `time` slot holds only the unit
  std::vector<std::string> notes;           // notices: ignored columns, left-out samples, implausible values

  bool has(Signal s) const { return !channels[index(s)].value.empty(); }
  const std::vector<double>& operator[](Signal s) const { return channels[index(s)].value; }
  std::size_t samples() const { return time.size(); }
};

struct ReadOptions {
  std::size_t minimum_rows = 20;
  bool require_response = true;  // at least one of spool, piston, both chamber pressures, load pressure or a flow
  bool require_drive = true;     // command or coil_current
};

// Reads a CSV log by the contract's rules. Throws InputError (file, line, column, rule, mend); nothing is returned half-read.
Log read_log(const std::string& path, const RigFile& rig = {}, const ReadOptions& options = {});

struct OutputColumn {
  Signal signal;
  std::string unit;           // written in the header, "name [unit]"
  std::vector<double> value;  // [SI]
};

// Writes a canonical CSV (shortest round-trip digits) to a temporary name and renames it.
void write_log(const std::string& path, const std::vector<OutputColumn>& columns, const std::vector<std::string>& comments = {});

}  // namespace servodx
