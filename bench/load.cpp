// Loading of a long log against one thread of std::from_chars over the same bytes, and the memory it takes.
//   servodx_load [ROWS]        writes the log to the temporary folder, reads it five times, prints medians of wall time
//
// What this does not prove: the file is in the page cache, so a disk's speed is not in it; rows are clean, so the slow
// paths (quotes, missing cells) are not timed.
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/random.h"
#include "signals/log.h"

using namespace servodx;

namespace {

constexpr int repeats = 5;

// Ten columns of twelve significant digits.
std::string long_log(long rows) {
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
  return text;
}

double median_seconds(const std::function<void()>& work) {
  std::vector<double> seconds;
  for (int k = 0; k < repeats; ++k) {
    const auto start = std::chrono::steady_clock::now();
    work();
    seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  std::nth_element(seconds.begin(), seconds.begin() + repeats / 2, seconds.end());
  return seconds[repeats / 2];
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
    write_file(path, long_log(rows));
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
  const double chars = median_seconds([&] {
    const char* p = text.data() + text.find('\n') + 1;
    const char* const end = text.data() + text.size();
    while (p < end) {
      double x = 0;
      p = std::from_chars(p, end, x).ptr + 1;
      sum += x;
    }
  });
  const double file = static_cast<double>(text.size()) / 1e6;
  fmt::print("{} rows, {:.0f} MB; sum {:.6g}\n", rows, file, sum);
  fmt::print("std::from_chars, one thread  {:.3f} s  {:.0f} MB/s\n", chars, file / chars);
  fmt::print("read_log                     {:.3f} s  {:.0f} MB/s  ratio {:.2f}\n", reader, file / reader,
             reader / chars);
  fmt::print("peak memory {:.0f} MB, of which {:.0f} MB before reading; the samples themselves are {:.0f} MB\n", peak,
             before, static_cast<double>(rows) * 10 * 8 / 1e6);
}
