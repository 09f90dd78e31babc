// A log of 1,000,000 rows: read_log against one thread of std::from_chars over the same bytes, wall time.
#include <fmt/format.h>

#include <filesystem>

#include "base/atomic_file.h"
#include "base/csv.h"
#include "long_log.h"
#include "ratios/measure.h"
#include "ratios/rows.h"
#include "signals/log.h"

namespace servodx::bench {

void loading_rows(Report& report, const Choice& choice) {
  constexpr long rows = 1000000;
  const std::string path = (std::filesystem::temp_directory_path() / "servodx_ratios.csv").string();
  const std::string text = long_log(rows);
  write_file(path, text);
  double sum = 0;
  const std::vector<Timing> t =
      take_turns({[&] { sum += static_cast<double>(read_log(path).samples()); }, [&] { sum += sum_of_numbers(text); }},
                 std::min(5, choice.turns), wall_seconds);
  std::filesystem::remove(path);
  const double ratio = t[0].median / t[1].median;
  report.add({"loading 1,000,000 rows against std::from_chars", "1.5x", "0.7x", fmt::format("{:.2f}x", ratio),
              fmt::format("{:.2f} to {:.2f} s; {:.0f} MB/s", t[0].low, t[0].high,
                          static_cast<double>(text.size()) / 1e6 / t[0].median)});
  report.json["load_vs_from_chars"] = ratio;
}

}  // namespace servodx::bench
