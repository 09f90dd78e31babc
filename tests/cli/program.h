// Runs the built program as a user does, in a folder of its own.
#pragma once
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>

#include "temporary_folder.h"

namespace servodx {

struct Ended {
  int code = -1;
  std::string out, err;
};

inline std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// A process that runs; one that has ended may stay in the list of them. What a test waits for comes while it does.
inline bool is_alive(int pid) {
  const std::string told = bytes_of("/proc/" + std::to_string(pid) + "/stat");
  const std::size_t name_ends = told.rfind(") ");
  return name_ends != std::string::npos && told[name_ends + 2] != 'Z' && told[name_ends + 2] != 'X';
}

// A folder to work in: the program runs there, so that its messages hold relative paths.
struct Desk : TemporaryFolder {
  // `arguments` as typed at a shell.
  Ended run(const std::string& arguments) const { return run_with("", arguments); }
  // `environment`: "NAME=value ..." ahead of the call.
  Ended run_with(const std::string& environment, const std::string& arguments) const {
    const TemporaryFolder streams;
    const std::string call = "cd '" + path.string() + "' && " + environment + " '" + SERVODX_PROGRAM + "' " +
                             arguments + " >'" + (streams / "out") + "' 2>'" + (streams / "err") + "'";
    const int status = std::system(call.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, bytes_of(streams / "out"), bytes_of(streams / "err")};
  }
  // Every file with its bytes: what a refused call must leave as it was.
  std::map<std::string, std::string> contents() const {
    std::map<std::string, std::string> all;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(path))
      all[entry.path().lexically_relative(path).string()] = entry.is_regular_file() ? bytes_of(entry.path()) : "";
    return all;
  }
};

inline std::string shipped_table() {
  return bytes_of(std::filesystem::path(SERVODX_SOURCE_DIR) / "params" / "borello2009.csv");
}

// The header and the first `rows` samples of a log of data/.
inline std::string excerpt(const std::string& log, int rows) {
  std::istringstream in(bytes_of(std::filesystem::path(SERVODX_SOURCE_DIR) / "data" / log));
  std::string text, line;
  for (int k = 0; k <= rows && std::getline(in, line);) {
    k += line.starts_with('#') ? 0 : 1;
    text += line + "\n";
  }
  return text;
}

// What the main job needs beside the logs that tune and the suspect: table, rig file, logs of a baseline.
inline void write_rig_and_baseline_logs(const Desk& desk) {
  desk.write("table.csv", shipped_table());
  desk.write("rig.toml", bytes_of(std::filesystem::path(SERVODX_SOURCE_DIR) / "data" / "rig.toml"));
  desk.write("b1.csv", excerpt("healthy/h15_no_supply_signals.csv", 300));
  desk.write("b2.csv", excerpt("healthy/h04_multisine.csv", 300));
  desk.write("b3.csv", excerpt("healthy/h03_sine_2hz.csv", 300));
}

// A quarter of a second of a rig at rest that is asked to move: columns in units other than SI, out of order.
inline std::string small_log(int rows = 250) {
  std::ostringstream text;
  text << "command [mA],time [ms],spool_position [um],pressure_b [bar],piston_position [mm],pressure_a "
          "[MPa],supply_pressure [bar]\n";
  for (int k = 0; k < rows; ++k)
    text << (k < 50    ? 0
             : k < 150 ? 4
                       : -3)
         << ',' << k << ',' << (k * 7) % 13 << ',' << 100 + (k * 5) % 3 << ',' << 0.01 * (k % 17) << ','
         << 10.0 + 0.01 * (k % 5) << ",207\n";
  return text.str();
}

// `text` with line `line` (1-based) replaced.
inline std::string with_line(const std::string& text, long line, const std::string& replacement) {
  std::istringstream in(text);
  std::string out, current;
  for (long n = 1; std::getline(in, current); ++n) out += (n == line ? replacement : current) + "\n";
  return out;
}

inline std::string replaced(std::string text, const std::string& what, const std::string& with) {
  const auto at = text.find(what);
  return at == std::string::npos ? "'" + what + "' is not in the text" : text.replace(at, what.size(), with);
}

}  // namespace servodx
