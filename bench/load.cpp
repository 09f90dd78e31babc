// Loading of a long log against one thread of std::from_chars over the same bytes, and the memory it takes.
//   servodx_load [ROWS]        writes the log to the temporary folder, reads it five times, prints medians of wall time
//
// What this does not prove: the file is in the page cache, so a disk's speed is not in it; rows are clean, so the slow
// paths (quotes, missing cells) are not timed.
#include <fmt/format.h>
#include <sys/resource.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/median.h"
#include "long_log.h"
#include "signals/log.h"

using namespace servodx;

namespace {

constexpr int repeats = 5;

double median_seconds(const std::function<void()>& work) {
  std::vector<double> seconds;
  for (int k = 0; k < repeats; ++k) {
    const auto start = std::chrono::steady_clock::now();
    work();
    seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return median(seconds);
}

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

}  // namespace

int main(int argc, char** argv) {
  const long rows = argc > 1 ? std::atol(argv[1]) : 1000000;
  const std::string path = (std::filesystem::temp_directory_path() / fmt::format("servodx_load_{}.csv", rows)).string();
  if (!std::filesystem::exists(path)) {
    write_file(path, bench::long_log(rows));
    fmt::print("wrote {}; run again to measure (the writing would count towards the peak memory)\n", path);
    return 0;
  }
  const double before = peak_megabytes();
  const double reader = median_seconds([&] {
    const Log log = read_log(path);
    if (log.samples() != static_cast<std::size_t>(rows)) std::exit(1);
  });
  const double peak = peak_megabytes();
  const std::string text = read_file(path);
  double sum = 0;
  const double chars = median_seconds([&] { sum += bench::sum_of_numbers(text); });
  const double file = static_cast<double>(text.size()) / 1e6;
  fmt::print("{} rows, {:.0f} MB; sum {:.6g}\n", rows, file, sum);
  fmt::print("std::from_chars, one thread  {:.3f} s  {:.0f} MB/s\n", chars, file / chars);
  fmt::print("read_log                     {:.3f} s  {:.0f} MB/s  ratio {:.2f}\n", reader, file / reader,
             reader / chars);
  fmt::print("peak memory {:.0f} MB, of which {:.0f} MB before reading; the samples themselves are {:.0f} MB\n", peak,
             before, static_cast<double>(rows) * 10 * 8 / 1e6);
}
