#include "signals/log.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/sha256.h"
#include "signals/plausible.h"

namespace servodx {
namespace {

// One column of the file that is a signal: where it goes and how its numbers become SI.
struct Column {
  Signal signal;
  std::string name;
  Unit unit;  // of the file's numbers
  double gain = 1.0;
  double offset = 0.0;
  std::string written_unit;
  double full_scale = 0.0;
  std::vector<double> raw;
  std::size_t missing = 0;
  long first_missing_line = 0;

  double to_si(double x) const {
    const double si = unit.to_si(x);
    return gain == 1.0 && offset == 0.0 ? si : gain * si + offset;
  }
};

struct HeaderCell {
  std::string name;
  std::string unit;
  bool has_unit = false;
};

std::string trimmed(std::string text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

HeaderCell parse_header(const std::string& cell) {
  const auto open = cell.rfind('[');
  if (open == std::string::npos || !cell.ends_with(']')) return {trimmed(cell), "", false};
  return {trimmed(cell.substr(0, open)), trimmed(cell.substr(open + 1, cell.size() - open - 2)), true};
}

// The names in the file that are no signal, for the mend of a missing one.
std::string in_quotes(const std::vector<std::string>& names) {
  constexpr std::size_t most = 6;
  std::string list;
  for (std::size_t i = 0; i < std::min(most, names.size()); ++i) list += (i ? ", '" : "'") + names[i] + "'";
  if (names.size() > most) list += fmt::format(" and {} more", names.size() - most);
  return list;
}

class LogReader {
 public:
  LogReader(const std::string& path, const RigFile& rig, const ReadOptions& options)
      : path_(path), rig_(rig), options_(options), text_(read_file(path)), csv_(text_, path) {}

  Log read() {
    log_.path = path_;
    log_.sha256 = sha256(text_);
    read_header();
    require_signals();
    read_rows();
    check_counts();
    convert();
    for (std::string& note : implausible_values(log_, rig_)) log_.notes.push_back(std::move(note));
    return std::move(log_);
  }

 private:
  Place header_place(const std::string& column) const { return {path_, csv_.header_line(), column}; }

  void read_header() {
    target_.assign(csv_.header().size(), -1);
    for (std::size_t i = 0; i < csv_.header().size(); ++i) {
      const HeaderCell cell = parse_header(csv_.header()[i]);
      auto mapping = rig_.columns.find(csv_.header()[i]);
      if (mapping == rig_.columns.end()) mapping = rig_.columns.find(cell.name);
      const bool mapped = mapping != rig_.columns.end();
      const auto signal = find_signal(mapped ? mapping->second.signal : cell.name);
      if (!signal) {
        ignored_.push_back(cell.name);
        continue;
      }
      for (const Column& other : columns_)
        if (other.signal == *signal)
          throw InputError(header_place(cell.name),
                           other.name == cell.name
                               ? "duplicate column"
                               : fmt::format("duplicate column: '{}' is '{}' too", other.name, info(*signal).name),
                           "keep one column of the signal");
      target_[i] = static_cast<int>(columns_.size());
      columns_.push_back(resolve(*signal, cell, mapped ? &mapping->second : nullptr));
    }
    if (!ignored_.empty())
      log_.notes.push_back(fmt::format("{}: ignored {} further column{}: {}", path_, ignored_.size(),
                                       ignored_.size() == 1 ? "" : "s", in_quotes(ignored_)));
  }

  // The unit of a column: from its header cell, or from the rig file, which may add a gain and an offset.
  Column resolve(Signal signal, const HeaderCell& cell, const ColumnMapping* mapping) const {
    const Place where = header_place(cell.name);
    const std::string mapped_unit = mapping ? mapping->column_unit : "";
    if (!cell.has_unit && mapped_unit.empty())
      throw InputError(
          where, "the header cell has no unit",
          fmt::format("write '{} [{}]'; accepted: {}", cell.name, info(signal).si_unit, accepted_units(signal)));
    if (cell.has_unit && !mapped_unit.empty() && cell.unit != mapped_unit)
      throw InputError(
          where, fmt::format("unit '{}' here, '{}' in the rig file (line {})", cell.unit, mapped_unit, mapping->line),
          "make both agree");
    const std::string name = cell.has_unit ? cell.unit : mapped_unit;
    const Unit* unit = find_unit(name);
    if (!unit) throw InputError(where, fmt::format("unknown unit '{}'", name), "accepted: " + accepted_units(signal));

    Column column{signal, cell.name, *unit, 1.0, 0.0, name, 0.0, {}, 0, 0};
    if (mapping) {
      column.gain = mapping->gain;
      column.offset = mapping->offset;
    }
    const auto relative = relative_unit(signal);
    if (mapping && mapping->gain_has_unit) {
      column.written_unit = mapping->unit;
    } else if (unit->dimension == Dimension::voltage && signal != Signal::time) {
      throw InputError(
          where, "volts need a gain",
          fmt::format("add \"{}\" = {{ signal = \"{}\", unit = \"{}\", gain = \"... {}/V\" }} to [columns] of "
                      "the rig file (--rig)",
                      cell.name, info(signal).name, name, info(signal).si_unit));
    } else if (relative && unit->dimension == relative->dimension) {
      const auto full = rig_.fact(std::string(relative->fact));
      if (!full)
        throw InputError(where, fmt::format("unit '{}' needs {}", name, relative->fact),
                         "give it in the rig file (--rig) or write the column in " + units_of(info(signal).dimension));
      column.unit.multiply *= *full;
      column.full_scale = *full;
    } else if (unit->dimension != info(signal).dimension) {
      throw InputError(where,
                       fmt::format("'{}' is a unit of {}, not of {}", name, name_of(unit->dimension),
                                   name_of(info(signal).dimension)),
                       "accepted: " + accepted_units(signal));
    }
    return column;
  }

  bool present(Signal signal) const {
    return std::any_of(columns_.begin(), columns_.end(), [&](const Column& c) { return c.signal == signal; });
  }

  [[noreturn]] void refuse_missing(Signal signal, const std::string& rule) const {
    std::string mend = fmt::format("add a column '{} [{}]', or map one of yours in [columns] of the rig file",
                                   info(signal).name, info(signal).si_unit);
    if (!ignored_.empty()) mend += " (not known: " + in_quotes(ignored_) + ")";
    throw InputError(header_place(std::string(info(signal).name)), rule, mend);
  }

  void require_signals() const {
    if (!present(Signal::time)) refuse_missing(Signal::time, "required signal is missing");
    if (options_.require_drive && !present(Signal::command) && !present(Signal::coil_current))
      refuse_missing(Signal::command, "required signal is missing, and so is 'coil_current'");
    if (!options_.require_response) return;
    for (Signal s : {Signal::spool_position, Signal::piston_position, Signal::load_pressure, Signal::flow_a,
                     Signal::flow_b, Signal::control_flow, Signal::leakage_flow})
      if (present(s)) return;
    if (present(Signal::pressure_a) && present(Signal::pressure_b)) return;
    refuse_missing(
        Signal::spool_position,
        "no response is logged (spool_position, piston_position, pressure_a with pressure_b, load_pressure or "
        "a flow)");
  }

  void read_rows() {
    const std::size_t width = target_.size();
    const std::size_t time_column = static_cast<std::size_t>(
        std::find_if(columns_.begin(), columns_.end(), [](const Column& c) { return c.signal == Signal::time; }) -
        columns_.begin());
    const std::size_t guess = text_.size() / (4 * width + 1);
    for (Column& column : columns_) column.raw.reserve(std::min(guess, std::size_t{1} << 16));
    std::vector<double> row(columns_.size());
    double previous = -std::numeric_limits<double>::infinity();
    while (csv_.next_row()) {
      std::optional<InputError> fault;
      std::size_t cells = 0;
      bool last_is_empty = false;
      for (; cells < width; ++cells) {
        const int to = target_[cells];
        if (to < 0) {
          if (!csv_.skip_cell()) break;
          continue;
        }
        const Cell kind = csv_.next_number(row[to]);
        if (kind == Cell::none) break;
        last_is_empty = kind == Cell::missing;
        if (kind == Cell::text && !fault)
          fault.emplace(Place{path_, csv_.line(), columns_[to].name},
                        fmt::format("'{}' is not a number", csv_.last_text()), number_mend());
      }
      std::size_t found = cells;
      while (csv_.skip_cell()) ++found;
      if (csv_.row_ended_by_file() && (fault || found != width || last_is_empty)) {
        log_.notes.push_back(
            fmt::format("{}:{}: dropped the last line: it is cut short and has no line end", path_, csv_.line()));
        break;
      }
      if (found != width)
        throw InputError({path_, csv_.line(), ""}, fmt::format("ragged row: {} cells, the header has {}", found, width),
                         found > width && csv_.separator() == ','
                             ? "write one cell a column; a decimal comma needs ';' as separator"
                             : "write one cell a column");
      if (fault) throw *fault;
      if (std::isnan(row[time_column])) {
        count_missing(columns_[time_column]);
        continue;
      }
      const double now = columns_[time_column].to_si(row[time_column]);
      if (!(now > previous))
        throw InputError({path_, csv_.line(), columns_[time_column].name},
                         fmt::format("time does not increase: {} s after {} s", now, previous),
                         "sort the rows and remove repeated ones");
      previous = now;
      last_line_ = csv_.line();
      for (std::size_t c = 0; c < columns_.size(); ++c) {
        if (std::isnan(row[c])) count_missing(columns_[c]);
        columns_[c].raw.push_back(row[c]);
      }
    }
  }

  void count_missing(Column& column) const {
    ++column.missing;
    if (column.first_missing_line == 0) column.first_missing_line = csv_.line();
  }

  std::string number_mend() const {
    return csv_.separator() == ';' ? "write a number, or leave the cell empty"
                                   : "write a number with a decimal point, or leave the cell empty";
  }

  void check_counts() {
    const std::size_t rows = columns_.front().raw.size();
    for (const Column& column : columns_) {
      const bool is_time = column.signal == Signal::time;
      const std::size_t all = rows + (is_time ? column.missing : 0);
      if (column.missing == 0) continue;
      if (static_cast<double>(column.missing) > missing_limit * static_cast<double>(all))
        throw InputError(
            {path_, column.first_missing_line, column.name},
            fmt::format("{} of {} samples are missing, more than {} %", column.missing, all, 100.0 * missing_limit),
            is_time ? "give every row its time" : "cut the log to where the signal is complete, or drop the column");
      log_.notes.push_back(
          is_time ? fmt::format("{}: left out {} of {} rows without a time", path_, column.missing, all)
                  : fmt::format("{}: '{}': left out {} of {} samples", path_, column.name, column.missing, all));
    }
    if (rows == 0)
      throw InputError({path_, csv_.header_line(), ""}, "the log has no rows",
                       "write one row a sample below the header");
    if (rows < options_.minimum_rows)
      throw InputError({path_, last_line_, ""},
                       fmt::format("the log has {} rows, at least {} are needed", rows, options_.minimum_rows),
                       "record for longer");
  }

  void convert() {
    for (Column& column : columns_) {
      Channel& channel = log_.channels[index(column.signal)];
      channel.unit = column.written_unit;
      channel.full_scale = column.full_scale;
      channel.column = column.name;
      channel.missing = column.missing;
      for (double& x : column.raw) x = column.to_si(x);
      channel.resolution = resolution(column.raw);
      if (column.signal == Signal::time)
        log_.time = std::move(column.raw);
      else
        channel.value = std::move(column.raw);
    }
  }

  // Smallest step between neighbours, and between the sorted values of an even sample of the record.
  static double resolution(const std::vector<double>& x) {
    constexpr std::size_t sampled = 4096;
    double largest = 0.0;
    for (double v : x)
      if (std::abs(v) > largest) largest = std::abs(v);
    const double rounding = 1e-12 * largest;
    double smallest = std::numeric_limits<double>::infinity();
    const auto consider = [&](double a, double b) {
      const double step = std::abs(b - a);
      if (step > rounding && step < smallest) smallest = step;
    };
    for (std::size_t i = 1; i < x.size(); ++i) consider(x[i - 1], x[i]);
    std::vector<double> some;
    const std::size_t stride = x.size() / sampled + 1;
    for (std::size_t i = 0; i < x.size(); i += stride)
      if (!std::isnan(x[i])) some.push_back(x[i]);
    std::sort(some.begin(), some.end());
    for (std::size_t i = 1; i < some.size(); ++i) consider(some[i - 1], some[i]);
    return std::isfinite(smallest) ? smallest : 0.0;
  }

  const std::string& path_;
  const RigFile& rig_;
  const ReadOptions& options_;
  const std::string text_;
  CsvCursor csv_;
  Log log_;
  std::vector<Column> columns_;
  std::vector<int> target_;  // of each file column: position in columns_, or -1
  std::vector<std::string> ignored_;
  long last_line_ = 0;
};

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

Log read_log(const std::string& path, const RigFile& rig, const ReadOptions& options) {
  return LogReader(path, rig, options).read();
}

OutputColumn output_column(const Log& log, Signal signal, std::vector<double> values) {
  const Channel& channel = log.channels[index(signal)];
  return {signal, channel.unit.empty() ? std::string(info(signal).si_unit) : channel.unit, std::move(values),
          channel.full_scale};
}

void write_log(const std::string& path, const std::vector<OutputColumn>& columns,
               const std::vector<std::string>& comments) {
  constexpr std::size_t chunk = std::size_t{1} << 20;
  std::vector<Unit> units;
  std::string text;
  for (const std::string& comment : comments) text += "# " + comment + "\n";
  for (const OutputColumn& column : columns) {
    const SignalInfo& signal = info(column.signal);
    const Unit* unit = find_unit(column.unit);
    const auto relative = relative_unit(column.signal);
    const bool is_relative = unit && relative && unit->dimension == relative->dimension && column.full_scale > 0.0;
    if (!unit || (unit->dimension != signal.dimension && !is_relative))
      throw InputError({path, 0, std::string(signal.name)}, "cannot be written in '" + column.unit + "'",
                       "use one of " + units_of(signal.dimension));
    if (column.value.size() != columns.front().value.size())
      throw std::logic_error("write_log: columns of different length");
    units.push_back(*unit);
    if (is_relative) units.back().multiply *= column.full_scale;
    text += fmt::format("{}{} [{}]", units.size() > 1 ? "," : "", signal.name, column.unit);
  }
  text += '\n';
  AtomicFile file(path);
  const std::size_t rows = columns.empty() ? 0 : columns.front().value.size();
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      if (c) text += ',';
      const double si = columns[c].value[i];
      if (!std::isnan(si)) append_number(text, number_in_unit(si, units[c]));
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

}  // namespace servodx
