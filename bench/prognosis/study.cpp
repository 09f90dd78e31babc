#include "prognosis/study.h"

#include <atomic>
#include <cmath>
#include <cstdio>
#include <exception>
#include <mutex>

#include "base/celsius.h"
#include "prognose/check_name.h"
#include "prognose/valve_history.h"
#include "rig/rig_model.h"
#include "servodx/log.h"

namespace servodx::study {

Condition random_condition(Random& random) {
  return {random.uniform(-30, 70), std::exp(random.uniform(std::log(0.002), std::log(0.02))),
          random.uniform(-0.015, 0.015)};
}

Log test_log(const rig::RigModel& valve, const std::string& fault, double severity, const Condition& at,
             rig::RigRun run) {
  run.temperature = at.celsius + zero_celsius;
  run.air = at.air;
  if (!fault.empty()) run.faults[fault] = severity;
  rig::RigModel here = valve;
  here.armature_null += at.null;
  Log log;
  log.path = "virtual rig";
  for (const OutputColumn& c : rig::run_rig(here, run).columns) {
    Channel& channel = log.channels[static_cast<std::size_t>(index(c.signal))];
    (c.signal == Signal::time ? log.time : channel.value) = c.value;
    channel.unit = c.unit;
  }
  return log;
}

rig::RigRun preflight(const std::string& test, std::uint64_t seed) {
  rig::RigRun run;
  run.excitation = test;
  run.duration = test == "preflight_wear" ? 2.75 : 1.51;
  run.seed = seed;
  return run;
}

Recording recording_of(double at, const CheckResult& result) {
  Recording r;
  r.at = at;
  r.temperature = result.temperature.value;
  r.temperature_source = name_of(result.temperature.source);
  r.checks = result.checks;
  return r;
}

const Check* find(const std::vector<Check>& checks, const CheckName& name) {
  for (const Check& c : checks)
    if (c.name == name) return &c;
  return nullptr;
}

void for_each(int n, const std::string& what, const std::function<void(int)>& work) {
  std::mutex mutex;
  std::exception_ptr failure;
  std::atomic<bool> failed{false};
  int done = 0;
#pragma omp parallel for schedule(dynamic, 1)
  for (int i = 0; i < n; ++i) {
    if (failed) continue;
    try {
      work(i);
      const std::lock_guard lock(mutex);
      std::fprintf(stderr, "\r%s: %d of %d ", what.c_str(), ++done, n);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failed.exchange(true)) failure = std::current_exception();
    }
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace servodx::study
