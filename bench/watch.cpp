// How many valves one core watches at the rate of their logs.
//   servodx_watch LOG RIG.toml TUNED.csv HEALTHY...    limits from HEALTHY; LOG is watched again and again
//
// One thread, one watcher after the other; what is printed is seconds of log watched in a second of the processor: so
// many valves in real time. Parsing of the text is timed apart. What this does not prove: samples come from memory, so
// the waits and the system calls of many open files are not in it; all valves have the same log and table.
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <string>
#include <vector>

#include "base/csv.h"
#include "online/alarm_limits.h"
#include "online/watched_model.h"
#include "online/watcher.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "signals/growing_log.h"
#include "signals/sample.h"
#include "signals/signal.h"

using namespace servodx;

namespace {

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) {
    fmt::print(stderr, "servodx_watch LOG RIG.toml TUNED.csv HEALTHY...\n");
    return 2;
  }
  constexpr double least_seconds = 300;  // [s] of log that are watched
  const Rig rig = read_rig_file(argv[2]);
  const WatchedModel model = watched_model(read_table(argv[3]), rig);
  std::vector<Log> healthy;
  for (int i = 4; i < argc; ++i) healthy.push_back(read_log(argv[i], rig));
  const WatchLimits limits = learn_limits(healthy, model, 0.1);

  const std::string text = read_file(argv[1]);
  GrowingLog log(argv[1], rig);
  std::vector<Sample> samples;
  double began = cpu_seconds();
  log.feed(text, [&](const Sample& s, std::uint64_t) { samples.push_back(s); });
  const double parsing = cpu_seconds() - began;
  std::vector<Signal> recorded;
  for (const SignalInfo& s : signal_list)
    if (s.signal != Signal::time && log.has(s.signal)) recorded.push_back(s.signal);
  const double seconds = samples.back().time - samples.front().time;

  double watched = 0;
  long alarms = 0;
  const double before = peak_megabytes();
  began = cpu_seconds();
  while (watched < least_seconds) {
    Watcher watcher(model, limits, recorded);
    std::vector<WatchEvent> events;
    for (const Sample& s : samples) watcher.take(s, events);
    alarms += std::count_if(events.begin(), events.end(),
                            [](const WatchEvent& e) { return e.kind == WatchEventKind::alarm; });
    watched += seconds;
  }
  const double watching = cpu_seconds() - began;
  fmt::print("{:.0f} s of log at {:.0f} Hz, {} alarms: {:.2f} s of one core\n", watched,
             static_cast<double>(samples.size() - 1) / seconds, alarms, watching);
  fmt::print("valves a core in real time: {:.0f} watched, {:.0f} with the reading of their text\n", watched / watching,
             1 / (watching / watched + parsing / seconds));
  fmt::print("memory beyond the samples: {:.1f} MB\n", peak_megabytes() - before);
}
