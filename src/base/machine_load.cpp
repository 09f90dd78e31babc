#include "base/machine_load.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>

#ifdef __linux__
#include <sys/resource.h>
#include <unistd.h>
#endif

namespace servodx {
namespace {

constexpr double much = 0.5;        // of the machine
constexpr double nearly_all = 0.9;  // busy beyond it, a run has nowhere to go
constexpr double least = 2.0;       // [s] of all cores: shorter, the kernel's ticks are too coarse

}  // namespace

std::optional<CpuTimes> cpu_times_of(const std::string& line, double ticks_per_second, double own) {
  std::istringstream in(line);
  std::string name;
  std::array<double, 8> ticks{};  // user nice system idle iowait irq softirq steal; what follows is part of user
  if (!(in >> name) || name != "cpu" || ticks_per_second <= 0) return {};
  for (double& tick : ticks)
    if (!(in >> tick)) return {};
  CpuTimes times;
  for (const double tick : ticks) times.all += tick / ticks_per_second;
  times.busy = times.all - (ticks[3] + ticks[4]) / ticks_per_second;
  times.own = own;
  return times;
}

std::optional<CpuTimes> cpu_times_now() {
#ifdef __linux__
  std::ifstream file("/proc/stat");
  std::string line;
  rusage used{};
  if (!std::getline(file, line) || getrusage(RUSAGE_SELF, &used) != 0) return {};
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return cpu_times_of(line, static_cast<double>(sysconf(_SC_CLK_TCK)), seconds(used.ru_utime) + seconds(used.ru_stime));
#else
  return {};
#endif
}

std::optional<double> part_of_others(const CpuTimes& from, const CpuTimes& to) {
  const double all = to.all - from.all;
  if (all < least) return {};
  return std::clamp(((to.busy - from.busy) - (to.own - from.own)) / all, 0.0, 1.0);
}

std::string crowd_line(const CpuTimes& from, const CpuTimes& to) {
  const auto part = part_of_others(from, to);
  if (!part || *part < much || to.busy - from.busy < nearly_all * (to.all - from.all)) return "";
  return fmt::format("other programs take {} % of this machine: this takes longer", std::lround(100 * *part));
}

}  // namespace servodx
