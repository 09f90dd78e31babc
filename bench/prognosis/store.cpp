// The trend of one valve out of a store of millions of figures.
#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <filesystem>

#include "base/random.h"
#include "prognose/trend.h"
#include "prognose/valve_history.h"
#include "prognosis/study.h"
#include "store/history.h"

namespace servodx::study {

void store(const std::string& file, long rows) {
  std::filesystem::remove(file);
  const auto seconds = [from = std::chrono::steady_clock::now()] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count();
  };
  constexpr long per_valve = 200, figures_of_one = 8;
  HistoryFile history(file, true);
  HistoryContent content;
  Random random(3);
  long written = 0;
  for (long v = 0; written < rows; ++v) {
    ValveHistory valve;
    valve.valve = fmt::format("v{}", v);
    for (long k = 0; k < per_valve && written < rows; ++k) {
      Recording r;
      r.at = static_cast<double>(k), r.log = "l", r.log_sha256 = fmt::format("{}-{}", v, k), r.table_sha256 = "t";
      r.version = "1", r.recorded_at = "2026-01-01T00:00:00Z", r.temperature = 313, r.temperature_source = "given";
      for (int c = 0; c < figures_of_one; ++c, ++written)
        r.checks.push_back({fmt::format("c{}", c), 1 + 0.01 * random.normal(), 0.01, "1", 1.0, 1.0, ""});
      valve.recordings.push_back(std::move(r));
    }
    content.valves.push_back(std::move(valve));
    if (content.valves.size() == 50 || written >= rows) history.restore(content), content.valves.clear();
  }
  std::printf("%ld rows in %.1f s\n", written, seconds());
  const double before = seconds();
  const ValveTrend t = trend(history.of("v7"), {});
  std::printf("trend of one valve of %zu checks: %.3f s\n", t.checks, seconds() - before);
}

}  // namespace servodx::study
