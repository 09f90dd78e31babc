#include <omp.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "servodx/rig.h"
#include "simulate/choose_kernel.h"
#include "simulate/company.h"
#include "simulate/kernels.h"
#include "simulate/scenario.h"
#include "simulate/simulate.h"

namespace servodx {
namespace {

// From so many candidates on, a run that leads and the derivatives of its steps cost less than packs of eight:
// measured, 4.0 simulations for 4.1 with 25 to 32, 4.7 for 6.2 with 41 to 48, 3.1 for 3.1 with 24.
constexpr std::size_t least_followers = 25;

std::unique_ptr<NearRuns> near_runs(const NearJobs& near, const SimulateOptions& options) {
  if (near.jobs.size() < least_followers || near.jobs[0].scenario->ports != Ports::actuator) return nullptr;
  const NearKernels& kernels = best_kernels().near;
  Need need = need_of(*near.base);  // of what followers have, the larger holds both
  for (const Job& job : near.jobs) need = std::max(need, need_of(*job.candidate));
  const NearKernels::Make make = kernels[need];
  if (!make) return nullptr;
  std::vector<const ParameterVector*> candidates;
  std::vector<Trajectory*> results;
  for (const Job& job : near.jobs) candidates.push_back(job.candidate), results.push_back(job.result);
  return make(*near.jobs[0].scenario, *near.base, *near.of_base, candidates.data(), results.data(),
              static_cast<int>(results.size()), options);
}

}  // namespace

long simulate_near(std::span<const NearJobs> logs, const SimulateOptions& options) {
  const int threads = options.threads > 0 ? options.threads : omp_get_max_threads();
  const auto n_logs = static_cast<long>(logs.size());
  std::vector<std::unique_ptr<NearRuns>> runs(logs.size());
  if (!company())  // there, lanes that stand idle are another's
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
    for (long l = 0; l < n_logs; ++l) runs[l] = near_runs(logs[l], options);
  std::vector<Job> others;
  long ran = 0;
  for (std::size_t l = 0; l < logs.size(); ++l) {
    ran += static_cast<long>(logs[l].jobs.size()) + (runs[l] != nullptr);
    if (!runs[l]) others.insert(others.end(), logs[l].jobs.begin(), logs[l].jobs.end());
  }
  if (!others.empty()) simulate(others, options);
  std::erase(runs, nullptr);
  // A stretch of steps at a time, so that followers find them in the cache; meanwhile the run goes on.
  constexpr int stretch = 48;
  struct Task {
    NearRuns* run;
    int follower;  // -1: leads
  };
  std::vector<Task> tasks;
  for (const auto& r : runs) tasks.push_back({r.get(), -1});
  for (const auto& r : runs)
    for (int f = 0; f < r->followers(); ++f) tasks.push_back({r.get(), f});
  const auto count = static_cast<long>(tasks.size());
  for (bool any = !tasks.empty(); any;) {
    any = false;
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads) reduction(|| : any)
    for (long k = 0; k < count; ++k) {
      if (tasks[k].follower >= 0)
        tasks[k].run->follow(tasks[k].follower);
      else if (tasks[k].run->lead(stretch))
        any = true;
    }
    for (const auto& r : runs) r->turn();
  }
  for (const auto& r : runs) r->end();
  return ran;
}

}  // namespace servodx
