// Progressive series of a rig: lead time, and which degradation is named. The checks are kept in OUT/*.csv, which
// `servodx history import` reads, and taken up again by the next run.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

#include "base/atomic_file.h"
#include "base/csv.h"
#include "parameters/list.h"
#include "prognose/check.h"
#include "prognose/trend.h"
#include "prognose/valve_history.h"
#include "prognosis/study.h"
#include "report/trend/trend_words.h"
#include "servodx/log.h"
#include "store/history.h"
#include "store/history_csv.h"

namespace servodx::study {
namespace {

namespace fs = std::filesystem;

ValveHistory checked(const Bench& b, const std::string& folder, const std::string& file) {
  ValveHistory h;
  for (int i = 0; i < n_parameters; ++i) h.tuned.push_back(b.tuned[i].nominal);
  if (fs::exists(file)) {
    h.recordings = read_history_csv(file).valves.front().recordings;
    h.valve = fs::path(folder).filename();
    return h;
  }
  h.valve = fs::path(folder).filename();
  std::vector<double> last;
  for (int k = 1;; ++k) {
    const std::string path = fmt::format("{}/t{:02}.csv", folder, k);
    if (!fs::exists(path)) break;
    const CheckResult r = check(read_log(path, b.rig), b.tuned, b.rig, {.threads = 1, .last = last});
    last = r.tracked;
    h.recordings.push_back(recording_of(k, r));
    h.recordings.back().log = fs::path(path).filename();
    h.recordings.back().log_sha256 = r.sha256;
    h.recordings.back().table_sha256 = b.tuned.sha256;
  }
  write_file(file, history_csv({{h}, {{b.tuned.sha256, read_file(b.tuned.path)}}}));
  return h;
}

}  // namespace

void series(const Bench& b, const std::string& out, const std::vector<std::string>& folders) {
  fs::create_directories(out);
  std::vector<ValveHistory> histories(folders.size());
  for_each(static_cast<int>(folders.size()), "series", [&](int i) {
    histories[i] = checked(b, folders[i], out + "/" + fs::path(folders[i]).filename().string() + ".csv");
  });
  for (const ValveHistory& h : histories) {
    const ValveTrend t = trend(h, {});
    const auto n = static_cast<double>(h.recordings.size());
    std::printf("\n%s: %zu checks, %s", h.valve.c_str(), h.recordings.size(), report::word_of(t.state));
    if (t.alert_at) std::printf(", alert at %g (lead %g checks to the last)", *t.alert_at, n - *t.alert_at);
    std::printf(", cause %s\n", t.cause.value_or("none").c_str());
    for (const double lambda : {0.5, 0.7, 0.9}) {
      ValveHistory seen = h;
      std::erase_if(seen.recordings, [&](const Recording& r) { return r.at > lambda * n; });
      const ValveTrend then = trend(seen, {});
      if (then.alert_at && then.remaining)
        std::printf("  at test %g: %s, end at test %.0f (%.0f to %.0f, 90 %%)\n", then.at,
                    then.cause.value_or("none").c_str(), then.at + then.remaining->median,
                    then.at + then.remaining->lower, then.at + then.remaining->upper);
      else
        std::printf("  at test %g: no alert\n", then.at);
    }
    for (const CheckTrend& c : t.trends)
      std::printf("  %-18s %-8s ln BF %7.1f  %10.4g -> %10.4g  alert %s\n", c.name.text().c_str(),
                  report::word_of(c.state), c.log_bayes_factor, c.healthy, c.now,
                  c.alert_at ? fmt::format("{}", *c.alert_at).c_str() : "-");
  }
}

}  // namespace servodx::study
