#include "parameters/table.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <span>
#include <sstream>
#include <string_view>

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/error.h"
#include "base/reading_limits.h"
#include "base/sha256.h"
#include "parameters/list.h"
#include "parameters/table_text.h"

namespace servodx {
namespace {

constexpr std::array<std::string_view, 11> required_columns = {
    "id", "name", "group", "nominal", "lower", "upper", "scale", "estimate", "unit", "description", "source"};
constexpr std::string_view std_error_column = "std_error";
constexpr std::string_view effect_prefix = "effect:";
constexpr std::string_view state_mark = "%";  // behind the '#' of a comment

// What cannot be zero or less: a chamber without volume or a piston without area runs away without a word.
constexpr int above_zero[] = {row::torque_motor_frequency,
                              row::hydraulic_amplifier_gain,
                              row::nozzle_gap,
                              row::fixed_orifice_diameter,
                              row::driver_bandwidth,
                              row::current_limit,
                              row::spool_diameter,
                              row::spool_stop,
                              row::port_width,
                              row::radial_clearance,
                              row::piston_area_a,
                              row::piston_area_b,
                              row::piston_stroke,
                              row::moving_mass,
                              row::dead_volume_a,
                              row::dead_volume_b,
                              row::supply_pressure,
                              row::bulk_modulus};
// What cannot be less than zero.
constexpr int not_negative[] = {
    row::filter_blockage_positive, row::filter_blockage_negative, row::valve_glitch,
    row::feedback_wire_stiffness,  row::spool_friction,           row::flow_force_coefficient,
    row::position_sensor_lag,      row::cross_piston_leakage,     row::piston_viscous_friction,
    row::piston_coulomb_friction,  row::piston_stribeck_friction, row::air_fraction,
    row::return_pressure,          row::hose_resistance,          row::hose_compliance};

// What cannot be more than one: parts of a whole.
constexpr int at_most_one[] = {row::filter_blockage_positive, row::filter_blockage_negative, row::air_fraction};
// [Pa] stiffness of a liquid: the softest solvents and the stiffest melts lie well within.
constexpr double softest_liquid = 1e7, stiffest_liquid = 1e11;

bool is_in(std::span<const int> rows, int row) { return std::find(rows.begin(), rows.end(), row) != rows.end(); }

std::string trimmed_start(std::string text) {
  if (text.starts_with(' ')) text.erase(0, 1);
  return text;
}

std::string number_text(double value) {
  std::string text;
  append_number(text, value);
  return text;
}

std::string with_unit(double value, std::string_view unit) {
  std::string text = number_text(value);
  if (unit != "-") text.append(" ").append(unit);
  return text;
}

struct Record {
  long line = 0;  // where it begins
  std::vector<std::string> cells;
};

bool next_record(CsvCursor& csv, Record& record) {
  record.cells.clear();
  if (!csv.next_row()) return false;
  record.line = csv.line();
  for (std::string cell; csv.next_cell(cell);) record.cells.push_back(cell);
  return true;
}

class Reader {
 public:
  explicit Reader(std::string path) : file_(std::move(path)) {}

  Table read(const std::string& text) {
    CsvCursor csv(text, file_);
    Table table;
    table.path = file_;
    table.sha256 = sha256(text);
    for (const std::string& comment : csv.comments())
      if (comment.starts_with(state_mark))
        table.state += trimmed_start(comment.substr(state_mark.size())) + "\n";
      else
        table.comments.push_back(comment);
    read_header({csv.header_line(), csv.header()});
    table.has_std_error = column_.contains(std::string(std_error_column));

    std::array<std::optional<Row>, n_parameters> known;
    std::array<long, n_parameters> known_line{};
    std::map<std::pair<std::string, std::string>, long> effect_line;
    std::vector<Row> effects;
    for (Record record; next_record(csv, record);) {
      Row row = read_row(record);
      if (row.id == 0) {
        const auto [it, is_new] = effect_line.try_emplace({row.group, row.name}, record.line);
        if (!is_new)
          fail(record, "name",
               "row '" + row.name + "' of '" + row.group + "' is here and on line " + std::to_string(it->second),
               "remove one of the two");
        effects.push_back(std::move(row));
      } else {
        const int i = row.id - 1;
        if (known[i])
          fail(record, "id",
               "row " + std::to_string(row.id) + " '" + row.name + "' is here and on line " +
                   std::to_string(known_line[i]),
               "remove one of the two");
        known_line[i] = record.line;
        known[i] = std::move(row);
      }
    }
    std::string missing;
    int n_missing = 0;
    for (int i = 0; i < n_parameters; ++i) {
      if (known[i]) continue;
      ++n_missing;
      missing +=
          (missing.empty() ? "" : ", ") + std::to_string(i + 1) + " '" + std::string(parameter_list[i].name) + "'";
    }
    if (n_missing > 0)
      throw InputError({file_, 0, "id"}, "the table lacks " + std::to_string(n_missing) + " of its 41 rows: " + missing,
                       "add them, for example from params/borello2009.csv");
    const double supply = known[row::supply_pressure]->nominal, back = known[row::return_pressure]->nominal;
    if (back >= supply)
      throw InputError({file_, known_line[row::return_pressure], "nominal"},
                       "'return_pressure' (" + with_unit(back, "Pa") + ") is not below 'supply_pressure' (" +
                           with_unit(supply, "Pa") + ", line " + std::to_string(known_line[row::supply_pressure]) + ")",
                       "check both values");
    for (auto& row : known) table.rows.push_back(std::move(*row));
    for (auto& row : effects) table.rows.push_back(std::move(row));
    return table;
  }

 private:
  [[noreturn]] void fail(const Record& record, std::string_view column, std::string rule, std::string mend) const {
    throw InputError({file_, record.line, std::string(column)}, std::move(rule), std::move(mend));
  }

  void read_header(const Record& header) {
    n_columns_ = header.cells.size();
    for (std::size_t i = 0; i < n_columns_; ++i) {
      const std::string& cell = header.cells[i];
      const bool known = cell == std_error_column ||
                         std::find(required_columns.begin(), required_columns.end(), cell) != required_columns.end();
      if (!known)
        fail(header, cell.empty() ? "(" + std::to_string(i + 1) + ")" : cell, "unknown column",
             "remove it; the columns are id,name,group,nominal,lower,upper,scale,estimate,unit,description,source "
             "and std_error");
      if (!column_.try_emplace(cell, i).second) fail(header, cell, "the column appears twice", "remove one of the two");
    }
    for (const auto name : required_columns)
      if (!column_.contains(std::string(name))) fail(header, name, "the column is missing", "add it to the header");
  }

  const std::string& cell(const Record& record, std::string_view column) const {
    return record.cells[column_.at(std::string(column))];
  }

  double number(const Record& record, std::string_view column) const {
    const std::string& text = cell(record, column);
    double value = 0;
    const char* first = text.data() + (text.starts_with('+') ? 1 : 0);
    const auto [end, status] = std::from_chars(first, text.data() + text.size(), value);
    if (status != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
      fail(record, column, "'" + text + "' is not a finite number", "write a number with a decimal point, like 1.4e9");
    return value;
  }

  void read_identity(const Record& record, Row& row) const {
    const std::string& id = cell(record, "id");
    row.name = cell(record, "name");
    row.group = cell(record, "group");
    if (row.name.empty()) fail(record, "name", "the name is empty", "write the parameter's name");
    const int by_name = find_parameter(row.name);
    if (id.empty()) {
      if (!row.group.starts_with(effect_prefix) || row.group.size() == effect_prefix.size())
        fail(record, "group", "a row without id belongs to an effect, but its group is '" + row.group + "'",
             by_name >= 0 ? "write id " + std::to_string(by_name + 1) + " for '" + row.name + "'"
                          : "write effect:NAME, or give the row its id");
      if (by_name >= 0)
        fail(record, "name", "'" + row.name + "' is the name of row " + std::to_string(by_name + 1),
             "give the effect's row a name of its own");
      return;
    }
    const auto [end, status] = std::from_chars(id.data(), id.data() + id.size(), row.id);
    if (status != std::errc() || end != id.data() + id.size() || row.id < 1 || row.id > n_parameters)
      fail(record, "id", "'" + id + "' is not a row number from 1 to 41",
           by_name >= 0 ? "write " + std::to_string(by_name + 1) + " for '" + row.name + "'"
                        : "write 1..41, or leave it empty for a row of an effect");
    const ParameterInfo& info = parameter_list[row.id - 1];
    if (row.name != info.name)
      fail(record, "name", "row " + id + " is '" + std::string(info.name) + "', not '" + row.name + "'",
           by_name >= 0 ? "write id " + std::to_string(by_name + 1) + " or name '" + std::string(info.name) + "'"
                        : "write '" + std::string(info.name) + "'");
    if (row.group != name_of(info.group))
      fail(record, "group",
           "'" + row.name + "' belongs to group '" + std::string(name_of(info.group)) + "', not '" + row.group + "'",
           "write '" + std::string(name_of(info.group)) + "'");
  }

  Row read_row(const Record& record) const {
    if (record.cells.size() != n_columns_)
      fail(record, "",
           "the row has " + std::to_string(record.cells.size()) + " cells, the header " + std::to_string(n_columns_),
           "quote cells that hold a comma, and fill or remove cells");
    Row row;
    read_identity(record, row);
    row.nominal = number(record, "nominal");
    row.lower = number(record, "lower");
    row.upper = number(record, "upper");

    row.unit = cell(record, "unit");
    if (row.id > 0 && row.unit != parameter_list[row.id - 1].unit)
      fail(record, "unit", "unknown unit '" + row.unit + "' for '" + row.name + "'",
           "write the values in SI and the unit '" + std::string(parameter_list[row.id - 1].unit) + "'");
    if (row.unit.empty()) fail(record, "unit", "the unit is empty", "write the SI unit, or '-' for a pure number");

    const std::string& scale = cell(record, "scale");
    if (scale != "lin" && scale != "log10")
      fail(record, "scale", "unknown scale '" + scale + "'", "write lin or log10");
    row.log_scale = scale == "log10";
    const std::string& estimate = cell(record, "estimate");
    if (estimate != "0" && estimate != "1")
      fail(record, "estimate", "'" + estimate + "' is neither 0 nor 1",
           "write 1 to free the row in a fit, 0 to hold it");
    row.estimate = estimate == "1";

    const std::string lower = with_unit(row.lower, row.unit), upper = with_unit(row.upper, row.unit);
    if (row.upper < row.lower)
      fail(record, "upper", "'" + row.name + "' upper (" + upper + ") is below lower (" + lower + ")",
           "swap them or widen 'upper'");
    if (row.nominal < row.lower || row.nominal > row.upper)
      fail(record, "nominal",
           "'" + row.name + "' nominal (" + with_unit(row.nominal, row.unit) + ") is outside its bounds (" + lower +
               " to " + upper + ")",
           std::string("move it inside or widen '") + (row.nominal < row.lower ? "lower'" : "upper'"));
    if (row.id > 0) require_sign(record, row);
    if (row.log_scale && row.lower <= 0)
      fail(record, "lower", "'" + row.name + "' has scale log10 but its lower bound is " + lower,
           "write a positive lower bound or scale lin");
    if (row.estimate && row.lower == row.upper)
      fail(record, "estimate", "'" + row.name + "' is to be estimated but its bounds are equal (" + lower + ")",
           "write estimate 0 or widen the bounds");

    row.description = cell(record, "description");
    row.source = cell(record, "source");
    if (column_.contains(std::string(std_error_column)) && !cell(record, std_error_column).empty()) {
      row.std_error = number(record, std_error_column);
      if (*row.std_error < 0)
        fail(record, std_error_column, "'" + row.name + "' has a negative standard error",
             "write a positive number, or leave it empty where it is not known");
    }
    return row;
  }

  // The bounds too: a fit goes where they let it.
  void require_sign(const Record& record, const Row& row) const {
    const bool positive = is_in(above_zero, row.id - 1), unsigned_row = positive || is_in(not_negative, row.id - 1);
    if (positive && row.nominal <= 0)
      fail(record, "nominal",
           "'" + row.name + "' is " + with_unit(row.nominal, row.unit) + ", and there is none of 0 or less",
           "write a positive value");
    if (unsigned_row && row.lower < 0)
      fail(record, "lower",
           "'" + row.name + "' may go down to " + with_unit(row.lower, row.unit) + ", and is never negative",
           "write a lower bound of 0 or more");
    if (is_in(at_most_one, row.id - 1) && row.upper > 1)
      fail(record, row.nominal > 1 ? "nominal" : "upper",
           "'" + row.name + "' " + (row.nominal > 1 ? "is " : "may go up to ") +
               with_unit(row.nominal > 1 ? row.nominal : row.upper, row.unit) + ", and is a part of a whole",
           "write a nominal value and an upper bound of 1 or less");
    if (row.id - 1 == row::bulk_modulus && !(row.lower >= softest_liquid && row.upper <= stiffest_liquid))
      fail(record, row.lower < softest_liquid ? "lower" : "upper",
           "'" + row.name + "' is " + with_unit(row.nominal, row.unit) + ", from " + with_unit(row.lower, row.unit) +
               " to " + with_unit(row.upper, row.unit) + ", and no liquid is as soft or as stiff",
           "write values between 1e7 Pa and 1e11 Pa: oils have about 1.4e9 Pa");
  }

  std::string file_;
  std::size_t n_columns_ = 0;
  std::map<std::string, std::size_t> column_;
};

}  // namespace

int Table::find(const std::string& name) const {
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (rows[i].name == name) return static_cast<int>(i);
  return -1;
}

Table read_table(const std::string& path) { return parse_table(read_file_within(path, largest_table), path); }
Table parse_table(const std::string& text, const std::string& path) { return Reader(path).read(text); }

std::string table_text(const Table& table) {
  std::string out;
  for (const auto& comment : table.comments) out += "# " + comment + "\n";
  std::istringstream state(table.state);
  for (std::string line; std::getline(state, line);) out += "#% " + line + "\n";
  for (std::size_t i = 0; i < required_columns.size(); ++i) {
    if (i > 0) out += ',';
    out += required_columns[i];
  }
  if (table.has_std_error) out.append(",").append(std_error_column);
  out += '\n';
  const auto text = [&](std::string_view cell) {
    out += ',';
    append_cell(out, cell);
  };
  const auto number = [&](double value) {
    out += ',';
    append_number(out, value);
  };
  for (const Row& row : table.rows) {
    if (row.id > 0) out += std::to_string(row.id);
    text(row.name);
    text(row.group);
    number(row.nominal);
    number(row.lower);
    number(row.upper);
    out += row.log_scale ? ",log10" : ",lin";
    out += row.estimate ? ",1" : ",0";
    text(row.unit);
    text(row.description);
    text(row.source);
    if (table.has_std_error) {
      if (row.std_error)
        number(*row.std_error);
      else
        out += ',';
    }
    out += '\n';
  }
  return out;
}

void write_table(const std::string& path, const Table& table) { write_file(path, table_text(table)); }

}  // namespace servodx
