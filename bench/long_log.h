// The log that loading is timed on, and the yardstick it is timed against.
#pragma once
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <string>

#include "base/random.h"

namespace servodx::bench {

// CSV of ten columns of twelve significant digits, clean rows at 1 kHz.
inline std::string long_log(long rows) {
  std::string text =
      "time [s],command [mA],spool_position [mm],piston_position [mm],pressure_a [bar],pressure_b [bar],"
      "supply_pressure [bar],return_pressure [bar],load_force [N],oil_temperature [degC]\n";
  Random random(1);
  for (long i = 0; i < rows; ++i) {
    const double t = 1e-3 * static_cast<double>(i), u = 20 * std::sin(0.3 * t);
    text += fmt::format("{:.12g}", t + 1e-7 * random.uniform());
    for (double x : {u, 0.025 * u, 3 * u, 100 + u, 100 - u, 207.0, 5.0, 50 * u, 40.0})
      text += fmt::format(",{:.12g}", x + 0.01 * random.normal());
    text += '\n';
  }
  return text;
}

// One thread of std::from_chars over the numbers below the header; their sum, so that no compiler leaves them out.
inline double sum_of_numbers(const std::string& text) {
  double sum = 0;
  const char* p = text.data() + text.find('\n') + 1;
  const char* const end = text.data() + text.size();
  while (p < end) {
    double x = 0;
    p = std::from_chars(p, end, x).ptr + 1;
    sum += x;
  }
  return sum;
}

}  // namespace servodx::bench
