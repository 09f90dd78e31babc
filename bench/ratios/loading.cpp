// A log of 1,000,000 rows: read_log against one thread of std::from_chars over the same bytes, wall time.
#include <fmt/format.h>

#include <charconv>
#include <filesystem>

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/random.h"
#include "ratios/measure.h"
#include "ratios/rows.h"
#include "signals/log.h"

namespace servodx::bench {

void loading_rows(Report& report, const Choice& choice) {
  constexpr long rows = 1000000;
  const std::string path = (std::filesystem::temp_directory_path() / "servodx_ratios.csv").string();
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
  write_file(path, text);
  double sum = 0;
  const std::vector<Timing> t = take_turns({[&] { sum += static_cast<double>(read_log(path).samples()); },
                                            [&] {
                                              const char* p = text.data() + text.find('\n') + 1;
                                              const char* const end = text.data() + text.size();
                                              while (p < end) {
                                                double x = 0;
                                                p = std::from_chars(p, end, x).ptr + 1;
                                                sum += x;
                                              }
                                            }},
                                           std::min(5, choice.turns), wall_seconds);
  std::filesystem::remove(path);
  const double ratio = t[0].median / t[1].median;
  report.add({"loading 1,000,000 rows against std::from_chars", "1.5x", "0.7x", fmt::format("{:.2f}x", ratio),
              fmt::format("{:.2f} to {:.2f} s; {:.0f} MB/s", t[0].low, t[0].high,
                          static_cast<double>(text.size()) / 1e6 / t[0].median)});
  report.json["load_vs_from_chars"] = ratio;
}

}  // namespace servodx::bench
