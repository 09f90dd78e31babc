#include "base/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace servodx {
namespace {

std::string time_text(double seconds) {
  const long s = std::lround(seconds);
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {} s", s / 60, s % 60);
  return fmt::format("{} h {} min", s / 3600, s % 3600 / 60);
}

// ", 1 min 5 s left"
std::string left_words(double undone, std::optional<double> rate) {
  constexpr double longest = 1e7;  // [s] beyond it the time left is a guess
  return rate && undone < longest * *rate ? ", " + time_text(undone / *rate) + " left" : "";
}

// One line of it in a run, whatever the number of works.
std::atomic<bool> crowd_told{false};

}  // namespace

std::string progress_line(const std::string& label, double fraction, long evaluations, double elapsed,
                          std::optional<double> rate) {
  fraction = std::clamp(fraction, 0.0, 1.0);
  std::string line = fmt::format("{}: {} %", label, static_cast<int>(100.0 * fraction));
  if (evaluations > 0 && elapsed > 0.0) {
    const double each = static_cast<double>(evaluations) / elapsed;
    line += each < 10.0 ? fmt::format(", {:.1f} evaluations/s", each) : fmt::format(", {:.0f} evaluations/s", each);
  }
  return line + left_words(1.0 - fraction, rate);
}

std::string logs_line(const std::string& label, std::size_t done, std::size_t of, std::size_t worked, double elapsed,
                      std::optional<double> rate) {
  std::string line = fmt::format("{}: {} of {} logs", label, done, of);
  if (worked == 0 || elapsed <= 0.0) return line;
  constexpr double minute = 60.0;  // [s]
  const double each = minute * static_cast<double>(worked) / elapsed;
  line += each < 10.0 ? fmt::format(", {:.1f} logs/min", each) : fmt::format(", {:.0f} logs/min", each);
  return line + left_words(static_cast<double>(of - done), rate);
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
  show([&](double elapsed) {
    rate_.add(elapsed, fraction);
    return progress_line(label_, fraction, evaluations, elapsed, rate_.per_second());
  });
}

void Progress::update_logs(std::size_t done, std::size_t of, std::size_t worked) {
  show([&](double elapsed) {
    rate_.add(elapsed, static_cast<double>(worked));
    return logs_line(label_, done, of, worked, elapsed, rate_.per_second());
  });
}

void Progress::say(const std::string& line) {
  if (options_.quiet) return;
  const std::lock_guard lock(mutex_);
  std::fputs((shown_ && terminal_ ? "\r\033[K" + line + "\n" : line + "\n").c_str(), options_.to);
  std::fflush(options_.to);
}

// A stretch between two readings is some seconds long: a shorter one is a moment's.
void Progress::tell_of_crowd() {
  constexpr double stretch = 8.0;  // [s] of all cores
  if (crowd_told || !load_) return;
  const auto now = cpu_times_now();
  if (!now || now->all - load_->all < stretch) return;
  const std::string line = crowd_line(*load_, *now);
  load_ = now;
  if (line.empty() || crowd_told.exchange(true)) return;
  std::fputs((terminal_ ? "\r\033[K" + line + "\n" : line + "\n").c_str(), options_.to);
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
  tell_of_crowd();
  std::fputs((terminal_ ? "\r" + words + "\033[K" : words + "\n").c_str(), options_.to);
  std::fflush(options_.to);
  shown_ = true;
}

}  // namespace servodx
