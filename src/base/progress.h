// One line of progress on standard error: label, part done, evaluations per second, time left at the recent rate.
//
// Silent for the first second, and throughout when quiet. A terminal sees one line rewritten; a file or a pipe sees a
// plain line every ten seconds. update() may be called from any thread and costs a clock reading when nothing is due.
// Once in a program's run a line says that other programs take much of the machine.
#pragma once
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

#include "base/machine_load.h"
#include "base/recent_rate.h"

namespace servodx {

struct ProgressOptions {
  bool quiet = false;
  std::FILE* to = stderr;
  std::optional<bool> terminal = {};  // empty: asked of the stream
  double first_after = 1.0;           // [s]
  double every_terminal = 0.2;        // [s]
  double every_plain = 10.0;          // [s]
};

class Progress {
 public:
  explicit Progress(std::string label, ProgressOptions options = {});
  ~Progress();  // clears the terminal's line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void update(double fraction, long evaluations);  // fraction 0..1 of the work; evaluations so far
  void update_logs(std::size_t done, std::size_t of, std::size_t worked);  // as logs_line() has them
  // A line of the caller's, made only when one is due. The others are this with a line below.
  void show(const std::function<std::string(double elapsed)>& line);
  void say(const std::string& line);  // at once, on a line of its own that stays; nothing when quiet

 private:
  using Clock = std::chrono::steady_clock;
  void tell_of_crowd();
  std::string label_;
  ProgressOptions options_;
  bool terminal_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point due_;
  std::mutex mutex_;
  bool shown_ = false;
  RecentRate rate_;
  std::optional<CpuTimes> load_ = cpu_times_now();
};

// "tune: 42 %, 12000 evaluations/s, 1 min 5 s left". `rate` [1/s]: of `fraction`, now; empty: no time left is said.
std::string progress_line(const std::string& label, double fraction, long evaluations, double elapsed,
                          std::optional<double> rate);

// "diagnose: 12 of 400 logs, 31 logs/min, 12 min 31 s left". `worked`: those of `done` that took work, in `elapsed`;
// `rate` [1/s]: of them, now.
std::string logs_line(const std::string& label, std::size_t done, std::size_t of, std::size_t worked, double elapsed,
                      std::optional<double> rate);

}  // namespace servodx
