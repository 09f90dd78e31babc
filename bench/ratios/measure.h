// Times on a machine that does other things too: what is compared takes turns, a thread's own processor time counts,
// and the median of the turns stands, with the lowest and the highest as spread.
#pragma once
#include <time.h>

#include <algorithm>
#include <functional>
#include <vector>

namespace servodx::bench {

struct Timing {
  double median = 0, low = 0, high = 0;  // [s]
};

inline double seconds_of(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}
inline double thread_seconds() { return seconds_of(CLOCK_THREAD_CPUTIME_ID); }
inline double wall_seconds() { return seconds_of(CLOCK_MONOTONIC); }

inline double median_of(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v.size() % 2 ? v[v.size() / 2] : 0.5 * (v[v.size() / 2 - 1] + v[v.size() / 2]);
}

// Each task once a turn; the first turn warms up and does not count.
inline std::vector<Timing> take_turns(const std::vector<std::function<void()>>& tasks, int turns,
                                      double (*clock)() = thread_seconds) {
  std::vector<std::vector<double>> seconds(tasks.size());
  for (int turn = 0; turn <= turns; ++turn)
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      const double from = clock();
      tasks[i]();
      if (turn > 0) seconds[i].push_back(clock() - from);
    }
  std::vector<Timing> out;
  for (const std::vector<double>& s : seconds)
    out.push_back({median_of(s), *std::min_element(s.begin(), s.end()), *std::max_element(s.begin(), s.end())});
  return out;
}

}  // namespace servodx::bench
