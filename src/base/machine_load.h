// Whether other programs take the machine that a run counts on: from the kernel's counters beside the run's own time.
//
// Counters of the whole machine, where the kernel shows them (/proc/stat, Linux). Inside a container they are the
// host's, which is what the run shares.
#pragma once
#include <optional>
#include <string>

namespace servodx {

// [s] since some start, of all cores together.
struct CpuTimes {
  double all = 0;   // cores times wall time
  double busy = 0;  // of it, not idle
  double own = 0;   // of it, this program's
};

// From the first line of /proc/stat, "cpu  user nice system idle iowait irq softirq steal ...". Empty where it is none.
std::optional<CpuTimes> cpu_times_of(const std::string& line, double ticks_per_second, double own);
std::optional<CpuTimes> cpu_times_now();

// Of the machine, 0 to 1, between two readings; empty where they are too near.
std::optional<double> part_of_others(const CpuTimes& from, const CpuTimes& to);
// "other programs take 90 % of this machine: this takes longer". Empty where they take less than half, or leave room.
std::string crowd_line(const CpuTimes& from, const CpuTimes& to);

}  // namespace servodx
