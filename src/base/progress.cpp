#include "base/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

namespace servodx {
namespace {

std::string time_text(double seconds) {
  const long s = std::lround(seconds);
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {} s", s / 60, s % 60);
  return fmt::format("{} h {} min", s / 3600, s % 3600 / 60);
}

}  // namespace

std::string progress_line(const std::string& label, double fraction, long evaluations, double elapsed) {
  fraction = std::clamp(fraction, 0.0, 1.0);
  std::string line = fmt::format("{}: {} %", label, static_cast<int>(100.0 * fraction));
  if (evaluations > 0 && elapsed > 0.0) {
    const double rate = static_cast<double>(evaluations) / elapsed;
    line += rate < 10.0 ? fmt::format(", {:.1f} evaluations/s", rate) : fmt::format(", {:.0f} evaluations/s", rate);
  }
  constexpr double least_fraction = 0.001;  // below it the time left is a guess
  constexpr double longest = 1e7;           // [s]
  const double left = fraction > 0.0 ? elapsed * (1.0 - fraction) / fraction : longest;
  if (fraction >= least_fraction && left < longest) line += ", " + time_text(left) + " left";
  return line;
}

std::string logs_line(const std::string& label, std::size_t done, std::size_t of, std::size_t worked, double elapsed) {
  std::string line = fmt::format("{}: {} of {} logs", label, done, of);
  if (worked == 0 || elapsed <= 0.0) return line;
  constexpr double minute = 60.0;  // [s]
  const double rate = minute * static_cast<double>(worked) / elapsed;
  line += rate < 10.0 ? fmt::format(", {:.1f} logs/min", rate) : fmt::format(", {:.0f} logs/min", rate);
  return line + ", " + time_text(minute * static_cast<double>(of - done) / rate) + " left";
}

Progress::Progress(std::string label, ProgressOptions options)
    : label_(std::move(label)),
      options_(options),
      terminal_(options.terminal.value_or(::isatty(::fileno(options.to)) == 1)),
      due_(start_ + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(options.first_after))) {}

Progress::~Progress() {
  if (!shown_ || !terminal_) return;
  std::fputs("\r\033[K", options_.to);
  std::fflush(options_.to);
}

void Progress::update(double fraction, long evaluations) {
  show([&](double elapsed) { return progress_line(label_, fraction, evaluations, elapsed); });
}

void Progress::say(const std::string& line) {
  if (options_.quiet) return;
  const std::lock_guard lock(mutex_);
  std::fputs((shown_ && terminal_ ? "\r\033[K" + line + "\n" : line + "\n").c_str(), options_.to);
  std::fflush(options_.to);
}

void Progress::show(const std::function<std::string(double elapsed)>& line) {
  if (options_.quiet) return;
  // Whoever finds another thread printing has nothing to add.
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock) return;
  const auto now = Clock::now();
  if (now < due_) return;
  const double every = terminal_ ? options_.every_terminal : options_.every_plain;
  due_ = now + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(every));
  const std::string words = line(std::chrono::duration<double>(now - start_).count());
  std::fputs((terminal_ ? "\r" + words + "\033[K" : words + "\n").c_str(), options_.to);
  std::fflush(options_.to);
  shown_ = true;
}

}  // namespace servodx
