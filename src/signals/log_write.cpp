// Logs out: canonical CSV whose numbers read back to the same bits.
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/units.h"
#include "servodx/error.h"
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
