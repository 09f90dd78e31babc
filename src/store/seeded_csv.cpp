#include "store/seeded_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>

#include "base/celsius.h"
#include "base/csv.h"
#include "base/error.h"
#include "base/reading_limits.h"
#include "base/units.h"
#include "model/state.h"
#include "prognose/check_name.h"
#include "simulate/scenario.h"

namespace servodx {

std::vector<SeededReading> read_seeded_csv(const std::string& path) {
  const std::string bytes = read_file_within(path, largest_history);
  CsvCursor cursor(bytes, path);
  enum { valve, name, truth, value, temperature, n_needed };
  constexpr std::array<const char*, n_needed> needed = {"valve", "name", "truth", "value", "oil_temperature [degC]"};
  std::array<std::size_t, n_needed> place{};
  bool kelvin = false;
  for (std::size_t c = 0; c < n_needed; ++c) {
    auto found = std::find(cursor.header().begin(), cursor.header().end(), needed[c]);
    if (c == temperature && found == cursor.header().end()) {
      found = std::find(cursor.header().begin(), cursor.header().end(), "oil_temperature [K]");
      kelvin = true;
    }
    if (found == cursor.header().end())
      throw InputError({path, cursor.header_line(), needed[c]}, "a seeded-fault test needs this column",
                       "add it to what 'servodx history export' writes of the test's checks");
    place[c] = static_cast<std::size_t>(found - cursor.header().begin());
  }
  std::vector<SeededReading> out;
  while (cursor.next_row()) {
    std::vector<std::string> cells;
    for (std::string cell; cursor.next_cell(cell);) cells.push_back(cell);
    if (cells.size() != cursor.header().size())
      throw InputError({path, cursor.line(), ""},
                       fmt::format("has {} cells, the header {}", cells.size(), cursor.header().size()),
                       "mend the row");
    if (cells[place[truth]].empty()) continue;
    const auto number = [&](std::size_t c) {
      const auto x = parse_number(cells[place[c]]);
      if (!x)
        throw InputError({path, cursor.line(), needed[c]}, "'" + cells[place[c]] + "' is not a number",
                         "write it with a point, without a unit");
      return *x;
    };
    const auto refuse = [&](std::size_t c, const std::string& mend) {
      throw InputError({path, cursor.line(), needed[c]}, "'" + cells[place[c]] + "' cannot be", mend);
    };
    const double kelvins = number(temperature) + (kelvin ? 0.0 : zero_celsius);
    if (kelvins < coldest_oil || kelvins > hottest_oil)
      refuse(temperature, "give the oil's temperature in the header's unit");
    if (number(truth) < 0) refuse(truth, "wear is 0 or more");
    out.push_back({cells[place[name]], cells[place[valve]], number(truth), number(value), log_viscosity(kelvins)});
  }
  if (out.empty())
    throw InputError({path, 0, "truth"}, "no row has one", "give the measured wear of each check's valve");
  std::map<CheckName, std::vector<SeededReading>> of_check;
  for (const SeededReading& r : out) of_check[r.check].push_back(r);
  for (const auto& [check, readings] : of_check) {
    if (check.kind() != CheckKind::parameter)
      throw InputError({path, 0, "name"}, "'" + check.text() + "' is no tracked parameter", "leave its truth empty");
    try {
      ReadingCurve(readings, {});
    } catch (const std::invalid_argument& e) {
      throw InputError({path, 0, ""}, check.text() + " " + e.what(),
                       "complete the test, or leave that check's truth empty");
    }
  }
  return out;
}

}  // namespace servodx
