// Logs out: canonical CSV whose numbers read back to the same bits.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/units.h"
#include "servodx/error.h"
#include "servodx/rig.h"
#include "signals/file_column.h"
#include "signals/log.h"

namespace servodx {
namespace {

double rounded_to_digits(double x, int digits) {
  char buffer[40];
  const auto written = std::to_chars(buffer, buffer + sizeof buffer, x, std::chars_format::scientific, digits - 1);
  double back = x;
  std::from_chars(buffer, written.ptr, back);
  return back;
}

// The shortest number in `unit` that reads back to `si`; the nearest one where no number does.
double number_in_unit(double si, const Unit& unit) {
  if (unit.multiply == 1.0 && unit.divide == 1.0 && unit.offset == 0.0) return si;
  const double x = unit.from_si(si);
  // An offset cancels digits, so fewer may do.
  for (int digits = unit.offset == 0.0 ? 15 : 12; digits <= 15; ++digits) {
    const double tidy = rounded_to_digits(x, digits);
    if (unit.to_si(tidy) == si) return tidy;
  }
  const double infinity = std::numeric_limits<double>::infinity();
  double below = x, above = x;
  for (int i = 0; i < 4; ++i) {
    if (unit.to_si(below) == si) return below;
    if (unit.to_si(above) == si) return above;
    below = std::nextafter(below, -infinity);
    above = std::nextafter(above, infinity);
  }
  return x;
}

}  // namespace

OutputColumn output_column(const Log& log, Signal signal, std::vector<double> values) {
  const Channel& channel = log.channels[index(signal)];
  return {signal, channel.unit.empty() ? std::string(info(signal).si_unit) : channel.unit, std::move(values),
          channel.full_scale};
}

std::vector<OutputColumn> columns_of(const Log& log) {
  std::vector<OutputColumn> columns = {output_column(log, Signal::time, log.time)};
  for (const SignalInfo& s : signal_list)
    if (log.has(s.signal)) columns.push_back(output_column(log, s.signal, log[s.signal]));
  return columns;
}

namespace {

// Of a signal, under its canonical name. `path` is for the refusal.
FileColumn canonical_column(const OutputColumn& column, const std::string& path) {
  const SignalInfo& signal = info(column.signal);
  const Unit* unit = find_unit(column.unit);
  const auto relative = relative_unit(column.signal);
  const bool is_relative = unit && relative && unit->dimension == relative->dimension && column.full_scale > 0.0;
  if (!unit || (unit->dimension != signal.dimension && !is_relative))
    throw InputError({path, 0, std::string(signal.name)}, "cannot be written in '" + column.unit + "'",
                     "use one of " + units_of(signal.dimension));
  FileColumn out{std::string(signal.name), column.unit, *unit, column.value};
  if (is_relative) out.scale.multiply *= column.full_scale;
  return out;
}

// "Pos fb [V]" with "Pos fb"
bool begins_with_name(const std::string& cell, const std::string& name) {
  return cell.size() > name.size() + 3 && cell.starts_with(name) && cell[name.size() + 1] == '[' && cell.back() == ']';
}

}  // namespace

FileColumn file_column(const Log& log, const Rig& rig, const OutputColumn& column) {
  FileColumn out = canonical_column(column, log.path);
  const std::string& name = log.channels[index(column.signal)].column;
  // The rig file names a column alone, or with the unit of its header cell.
  const auto found = std::find_if(rig.columns.begin(), rig.columns.end(), [&](const auto& c) {
    return find_signal(c.second.signal) == column.signal && (c.first == name || begins_with_name(c.first, name));
  });
  if (name.empty() || found == rig.columns.end()) return out;
  const ColumnMapping& mapping = found->second;
  out.name = name;
  // With a gain that has a unit the file's numbers are in the mapping's own unit, else in the log's.
  if (mapping.gain_has_unit && !mapping.column_unit.empty()) {
    out.unit = mapping.column_unit;
    out.scale = *find_unit(mapping.column_unit);
  }
  if (found->first != name) out.unit = found->first.substr(name.size() + 2, found->first.size() - name.size() - 3);
  out.scale.multiply *= mapping.gain;
  out.scale.offset = mapping.gain * out.scale.offset + mapping.offset;
  return out;
}

void write_columns(const std::string& path, const std::vector<FileColumn>& columns,
                   const std::vector<std::string>& comments) {
  constexpr std::size_t chunk = std::size_t{1} << 20;
  std::string text;
  for (const std::string& comment : comments) text += "# " + comment + "\n";
  for (const FileColumn& column : columns) {
    if (column.value.size() != columns.front().value.size())
      throw std::logic_error("write_columns: columns of different length");
    if (&column != &columns.front()) text += ',';
    append_cell(text, fmt::format("{} [{}]", column.name, column.unit));
  }
  text += '\n';
  AtomicFile file(path);
  const std::size_t rows = columns.empty() ? 0 : columns.front().value.size();
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      if (c) text += ',';
      const double si = columns[c].value[i];
      if (!std::isnan(si)) append_number(text, number_in_unit(si, columns[c].scale));
    }
    text += '\n';
    if (text.size() >= chunk) {
      file.write(text);
      text.clear();
    }
  }
  file.write(text);
  file.commit();
}

void write_log(const std::string& path, const std::vector<OutputColumn>& columns,
               const std::vector<std::string>& comments) {
  std::vector<FileColumn> as_written;
  for (const OutputColumn& column : columns) as_written.push_back(canonical_column(column, path));
  write_columns(path, as_written, comments);
}

}  // namespace servodx
