// The parameter table file (params/*.csv, tuned tables): 41 rows, and further rows with group `effect:NAME`.
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace servodx {

// What logs say of a row that a fit set free.
enum class RowVerdict {
  bounded,     // they tell it
  one_sided,   // they tell how far it may go on one side
  flat,        // it moves no channel
  at_bound,    // the end of its range holds it
  confounded,  // what it does others do, within the noise
  frozen,      // it was not asked
};

struct Row {
  int id = 0;  // 1..41; 0 for a row of an effect
  std::string name;
  std::string group;                         // first_stage, ..., or effect:NAME
  double nominal = 0, lower = 0, upper = 0;  // [unit]
  bool log_scale = false;                    // searched in log10
  bool estimate = false;                     // free in a fit
  std::string unit, description, source;
  std::optional<double> std_error;  // [unit], in a tuned table
};

struct Table {
  std::string path;
  std::string sha256;                 // of the file's bytes; a baseline is bound by content_hash() in its place
  std::vector<Row> rows;              // the 41 in order of id, then the effects' rows
  std::vector<std::string> comments;  // lines beginning with '#' before the header, for people
  std::string state;                  // lines beginning with '#%' there: what tuned the table (docs/parameters.md)
  bool has_std_error = false;         // a tuned table
  const Row& operator[](int position) const { return rows[position]; }
  Row& operator[](int position) { return rows[position]; }
  int find(const std::string& name) const;  // position, or -1
};

// Throws InputError with file, line, column, rule and mend.
Table read_table(const std::string& path);
// Written to a temporary name and renamed; shortest round-trip digits.
void write_table(const std::string& path, const Table& table);

// Hash of what the table says, rows and state: independent of its path, of comments and of how numbers are written.
std::string content_hash(const Table& table);

}  // namespace servodx
