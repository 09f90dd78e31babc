#include "signals/log_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/nearest.h"
#include "base/small_letters.h"
#include "base/trimmed.h"
#include "base/trouble.h"
#include "base/units.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "signals/header.h"
#include "signals/plausible.h"

namespace servodx {
namespace {

constexpr double beyond_all_units = 1e100;  // a number up to here stays finite in SI, whatever its unit and gain

struct NameAndUnit {
  std::string name;
  std::string unit;
  bool has_unit = false;
};

NameAndUnit parse_name(const std::string& cell) {
  const auto open = cell.rfind('[');
  if (open == std::string::npos || !cell.ends_with(']')) return {std::string(trimmed(cell)), "", false};
  const std::string_view text = cell;
  return {std::string(trimmed(text.substr(0, open))),
          std::string(trimmed(text.substr(open + 1, text.size() - open - 2))), true};
}

// The names in the file that are no signal, for the mend of a missing one.
std::string in_quotes(const std::vector<std::string>& names) {
  constexpr std::size_t most = 6;
  std::string list;
  for (std::size_t i = 0; i < std::min(most, names.size()); ++i) list += (i ? ", '" : "'") + names[i] + "'";
  if (names.size() > most) list += fmt::format(" and {} more", names.size() - most);
  return list;
}

// Smallest step between neighbours, and between the sorted values of an even sample of the record.
double resolution(const std::vector<double>& x, const Sweep& sweep) {
  constexpr std::size_t sampled = 4096;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (sweep.low > sweep.high) return 0.0;  // all are missing
  const double rounding = 1e-12 * std::max(std::abs(sweep.low), std::abs(sweep.high));
  const auto step = [&](double a, double b) {
    const double d = std::abs(b - a);
    return d > rounding ? d : infinity;  // NaN is no step
  };
  double smallest = sweep.least_step;
  if (smallest <= rounding) {
    smallest = infinity;
#pragma omp simd reduction(min : smallest)
    for (std::size_t i = 1; i < x.size(); ++i) smallest = std::min(smallest, step(x[i - 1], x[i]));
  }
  std::vector<double> some;
  const std::size_t stride = x.size() / sampled + 1;
  for (std::size_t i = 0; i < x.size(); i += stride)
    if (!std::isnan(x[i])) some.push_back(x[i]);
  std::sort(some.begin(), some.end());
  for (std::size_t i = 1; i < some.size(); ++i) smallest = std::min(smallest, step(some[i - 1], some[i]));
  return std::isfinite(smallest) ? smallest : 0.0;
}

}  // namespace

LogColumns::LogColumns(std::string path, const RigFile& rig, const ReadOptions& options, const LogFormat& format)
    : path_(std::move(path)),
      rig_(rig),
      options_(options),
      format_(format),
      previous_(-std::numeric_limits<double>::infinity()) {
  log_.path = path_;
}

void LogColumns::refuse_as(Trouble trouble, long line, const std::string& column, const std::string& rule,
                           const std::string& mend) const {
  const InputError error = refusal(line, column, rule, mend);
  throw DocumentedError(trouble, error.where, error.rule, error.mend);
}

void LogColumns::refuse(long line, const std::string& column, const std::string& rule, const std::string& mend) const {
  throw refusal(line, column, rule, mend);
}

InputError LogColumns::refusal(long line, const std::string& column, const std::string& rule,
                               const std::string& mend) const {
  if (format_.has_lines) return {{path_, line, column}, rule, mend};
  return {{path_, 0, column}, line > 0 ? fmt::format("sample {}: {}", line, rule) : rule, mend};
}

const ColumnMapping* LogColumns::mapping_of(const std::string& cell, const std::string& name) const {
  auto mapping = rig_.columns.find(cell);
  if (mapping == rig_.columns.end()) mapping = rig_.columns.find(name);
  return mapping == rig_.columns.end() ? nullptr : &mapping->second;
}

bool LogColumns::knows(const std::string& cell) const {
  const std::string name = format_.has_units ? parse_name(cell).name : cell;
  const ColumnMapping* const mapping = mapping_of(cell, name);
  return find_signal(mapping ? mapping->signal : name).has_value();
}

int LogColumns::add(const std::string& cell, long line) {
  header_line_ = line;
  const NameAndUnit written = format_.has_units ? parse_name(cell) : NameAndUnit{cell, "", false};
  const ColumnMapping* const mapping = mapping_of(cell, written.name);
  const auto signal = find_signal(mapping ? mapping->signal : written.name);
  if (!signal) {
    ignored_.push_back(written.name);
    return -1;
  }
  for (const Column& other : columns_)
    if (other.signal == *signal)
      refuse(line, written.name,
             other.name == written.name
                 ? "duplicate column"
                 : fmt::format("duplicate column: '{}' is '{}' too", other.name, info(*signal).name),
             "keep one column of the signal");
  if (*signal == Signal::time) time_ = static_cast<int>(columns_.size());
  columns_.push_back(resolve(*signal, written.name, written.unit, written.has_unit, mapping));
  return static_cast<int>(columns_.size()) - 1;
}

// The unit of a column: from its name in the file, or from the rig file, which may add a gain and an offset.
LogColumns::Column LogColumns::resolve(Signal signal, const std::string& column_name, const std::string& written_unit,
                                       bool has_unit, const ColumnMapping* mapping) const {
  const auto refuse_here = [&](const std::string& rule, const std::string& mend) {
    refuse_as(Trouble::unit, format_.has_lines ? header_line_ : 0, column_name, rule, mend);
  };
  const std::string mapped_unit = mapping ? mapping->column_unit : "";
  const auto in_rig_file = [&](const std::string& what) {
    return fmt::format("add \"{}\" = {{ signal = \"{}\", {} }} to [columns] of the rig file (--rig)", column_name,
                       info(signal).name, what);
  };
  if (!has_unit && mapped_unit.empty()) {
    if (mapping && format_.has_units)
      refuse_here("the header cell has no unit in square brackets, nor has the rig file",
                  fmt::format("add unit = \"...\" to its line in [columns] (line {}); accepted: {}", mapping->line,
                              accepted_units(signal)));
    if (format_.has_units)
      refuse_here("the header cell has no unit", fmt::format("write '{} [{}]'; accepted: {}", column_name,
                                                             info(signal).si_unit, accepted_units(signal)));
    refuse_here("the variable has no unit", in_rig_file(fmt::format("unit = \"{}\"", info(signal).si_unit)) +
                                                "; accepted: " + accepted_units(signal));
  }
  // The rig file says what a header means that the table does not know: "[deg C]", or "[%]" of what.
  const bool means = find_unit(written_unit) && !(written_unit == "%" && mapped_unit.starts_with("% of "));
  if (has_unit && means && !mapped_unit.empty() && written_unit != mapped_unit)
    refuse_here(fmt::format("unit '{}' here, '{}' in the rig file (line {})", written_unit, mapped_unit, mapping->line),
                "make both agree");
  const std::string name = has_unit && (means || mapped_unit.empty()) ? written_unit : mapped_unit;
  const Unit* unit = find_unit(name);
  if (!unit) refuse_here(fmt::format("unknown unit '{}'", name), "accepted: " + accepted_units(signal));

  Column column{signal, column_name, *unit, 1.0, 0.0, name};
  if (mapping) {
    column.gain = mapping->gain;
    column.offset = mapping->offset;
  }
  const auto relative = relative_unit(signal);
  if (mapping && mapping->gain_has_unit) {
    column.written_unit = mapping->unit;
  } else if (unit->dimension == Dimension::voltage && signal != Signal::time) {
    refuse_here("volts need a gain",
                in_rig_file(fmt::format("unit = \"{}\", gain = \"... {}/V\"", name, info(signal).si_unit)));
  } else if (relative && unit->dimension == relative->dimension) {
    const auto full = rig_.fact(std::string(relative->fact));
    if (!full)
      refuse_here(fmt::format("unit '{}' needs {}", name, relative->fact),
                  "give it in the rig file (--rig) or write the column in " + units_of(info(signal).dimension));
    column.unit.multiply *= *full;
    column.full_scale = *full;
  } else if (unit->dimension != info(signal).dimension) {
    refuse_here(
        fmt::format("'{}' is a unit of {}, not of {}", name, name_of(unit->dimension), name_of(info(signal).dimension)),
        "accepted: " + accepted_units(signal));
  }
  return column;
}

bool LogColumns::present(Signal signal) const {
  return std::any_of(columns_.begin(), columns_.end(), [&](const Column& c) { return c.signal == signal; });
}

void LogColumns::refuse_missing(Signal signal, const std::string& rule) const {
  const std::string name(info(signal).name);
  std::string mend = format_.has_units ? fmt::format("add a column '{} [{}]'", name, info(signal).si_unit)
                                       : fmt::format("add a variable '{}'", name);
  mend += rig_.path.empty() ? ", or map one of yours in [columns] of a rig file and give that with --rig"
                            : ", or map one of yours in [columns] of the rig file";
  if (format_.has_lines) mend += " ('servodx init LOG' begins one)";
  if (!ignored_.empty()) mend += "; not known: " + in_quotes(ignored_);
  // A recorder's column of comments is no command.
  std::vector<std::string> meant = ignored_;
  std::erase_if(meant, is_name_of_comments);
  std::string near = nearest_word(name, meant);
  for (const std::string& ignored : meant)
    if (in_small_letters(ignored) == name) near = ignored;
  if (!near.empty()) mend += fmt::format("; did you mean '{}' by '{}'?", name, near);
  refuse_as(Trouble::signal, format_.has_lines ? header_line_ : 0, name, rule, mend);
}

void LogColumns::require_signals() const {
  if (!present(Signal::time)) refuse_missing(Signal::time, "required signal is missing");
  if (options_.require_drive && !present(Signal::command) && !present(Signal::coil_current))
    refuse_missing(Signal::command, "required signal is missing, and so is 'coil_current'");
  if (!options_.require_response) return;
  for (Signal s : {Signal::spool_position, Signal::piston_position, Signal::load_pressure, Signal::flow_a,
                   Signal::flow_b, Signal::control_flow, Signal::leakage_flow})
    if (present(s)) return;
  if (present(Signal::pressure_a) && present(Signal::pressure_b)) return;
  refuse_missing(Signal::spool_position,
                 "no response is logged (spool_position, piston_position, pressure_a with pressure_b, load_pressure or "
                 "a flow)");
}

void LogColumns::refuse_rows(long line) const {
  refuse(line, "", fmt::format("the log has more than {} rows", format_.most_rows), "cut it into shorter ones");
}

void LogColumns::reserve(std::size_t samples) {
  for (Column& column : columns_) column.value.reserve(std::min(samples, format_.most_rows));
}

void LogColumns::append(std::span<const double> sample, long line) {
  const auto missing = [&](Column& column) {
    ++column.missing;
    if (column.first_missing_line == 0) column.first_missing_line = line;
  };
  Column& time = columns_[time_];
  if (std::isnan(sample[time_])) return missing(time);
  const double now = time.to_si(sample[time_]);
  if (!std::isfinite(now))
    refuse(line, time.name, fmt::format("{} {} is no finite time", sample[time_], time.unit.name), "mend the number");
  if (!(now > previous_))
    refuse_as(Trouble::time, line, time.name, fmt::format("time does not increase: {} s after {} s", now, previous_),
              now == previous_ ? "export times with more digits, or remove the repeated row"
                               : "sort the rows, or cut the file where a recording begins");
  if (time.value.size() == format_.most_rows) refuse_rows(line);
  previous_ = now;
  last_line_ = line;
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    if (std::isnan(sample[c])) missing(columns_[c]);
    if (std::abs(sample[c]) > beyond_all_units && !std::isfinite(columns_[c].to_si(sample[c])))
      refuse(line, columns_[c].name,
             fmt::format("{} {} is no finite number of {}", sample[c], columns_[c].unit.name,
                         info(columns_[c].signal).si_unit),
             "mend the number, or leave the cell empty where the sample is missing");
    columns_[c].value.push_back(sample[c]);
  }
}

void LogColumns::append_columns(const std::vector<std::span<const double>>& values) {
  const std::size_t samples = values[static_cast<std::size_t>(time_)].size();
  for (std::size_t c = 0; c < values.size(); ++c)
    if (values[c].size() != samples)
      refuse(0, columns_[c].name, fmt::format("has {} samples, the time has {}", values[c].size(), samples),
             "save signals of one length; for a second recorder see 'servodx join'");
  if (samples > format_.most_rows) refuse_rows(0);
  reserve(samples);
  std::vector<double> row(values.size());
  for (std::size_t k = 0; k < samples; ++k) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      row[c] = values[c][k];
      if (std::isinf(row[c]))
        refuse(static_cast<long>(k + 1), columns_[c].name, "is infinite", "write NaN for a missing sample");
    }
    append(row, static_cast<long>(k + 1));
  }
}

void LogColumns::check_counts() {
  const std::size_t rows = columns_[time_].value.size();
  for (const Column& column : columns_) {
    const bool is_time = column.signal == Signal::time;
    const std::size_t all = rows + (is_time ? column.missing : 0);
    if (column.missing == 0) continue;
    if (static_cast<double>(column.missing) > missing_limit * static_cast<double>(all))
      refuse(column.first_missing_line, column.name,
             fmt::format("{} of {} samples are missing, more than {} %", column.missing, all, 100.0 * missing_limit),
             is_time ? "give every row its time" : "cut the log to where the signal is complete, or drop the column");
    note(Note::Kind::left_out,
         is_time ? fmt::format("{}: left out {} of {} rows without a time", path_, column.missing, all)
                 : fmt::format("{}: '{}': left out {} of {} samples", path_, column.name, column.missing, all));
  }
  if (rows == 0)
    refuse(format_.has_lines ? header_line_ : 0, "", "the log has no rows", "write one row a sample below the header");
  if (rows < options_.minimum_rows)
    refuse(format_.has_lines ? last_line_ : 0, "",
           fmt::format("the log has {} rows, at least {} are needed", rows, options_.minimum_rows),
           "record for longer");
}

// What the rig file maps and the log has under no name: a misspelt column is else dropped without a word.
void LogColumns::note_unmapped() {
  for (const auto& [column, mapping] : rig_.columns) {
    const auto signal = find_signal(mapping.signal);
    if (!signal || present(*signal)) continue;
    const std::string near = nearest_word(column, ignored_);
    note(Note::Kind::unmapped_column,
         fmt::format("{}: the rig file maps column '{}' to '{}' (line {}), and the log has none of that name: {}",
                     path_, column, mapping.signal, mapping.line,
                     near.empty() ? "give the column its name in the log, or read on without the signal"
                                  : fmt::format("is it '{}'?", near)));
  }
}

Sweep LogColumns::Column::into_si() {
  const bool is_si = unit.multiply == 1.0 && unit.divide == 1.0 && unit.offset == 0.0 && gain == 1.0 && offset == 0.0;
  Sweep sweep;
  for (std::size_t from = 0, to; from < value.size(); from = to) {
    to = std::min(value.size(), from + Sweep::stretch);
    if (!is_si)
      for (std::size_t i = from; i < to; ++i) value[i] = to_si(value[i]);
    sweep.take(value, from, to);
  }
  return sweep;
}

Log LogColumns::finish(std::string sha256) {
  log_.sha256 = std::move(sha256);
  if (!ignored_.empty())
    log_.notes.insert(log_.notes.begin(), {Note::Kind::ignored_columns,
                                           fmt::format("{}: ignored {} further {}{}: {}", path_, ignored_.size(),
                                                       format_.has_units ? "column" : "variable",
                                                       ignored_.size() == 1 ? "" : "s", in_quotes(ignored_))});
  note_unmapped();
  check_counts();
  const int n = static_cast<int>(columns_.size());
  std::array<Sweep, n_signals> sweeps;
#pragma omp parallel for schedule(dynamic, 1)
  for (int c = 0; c < n; ++c) {
    Column& column = columns_[c];
    const Sweep& sweep = sweeps[index(column.signal)] = column.into_si();
    Channel& channel = log_.channels[index(column.signal)];
    channel.unit = column.written_unit;
    channel.full_scale = column.full_scale;
    channel.column = column.name;
    channel.missing = column.missing;
    channel.resolution = resolution(column.value, sweep);
    (column.signal == Signal::time ? log_.time : channel.value) = std::move(column.value);
  }
  for (const Note& found : implausible_values(log_, rig_, sweeps))
    note(found.kind, found.text + mark_of(Trouble::implausible));
  return std::move(log_);
}

}  // namespace servodx
