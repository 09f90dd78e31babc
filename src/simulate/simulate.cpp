#include "simulate/simulate.h"

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <tuple>
#include <utility>

#include "base/meeting.h"
#include "effects/line_inertia.h"
#include "effects/registry.h"
#include "effects/unexplained.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "simulate/kernel.h"
#include "simulate/run_in_parts.h"
#include "simulate/together.h"

namespace servodx {
namespace {

struct Choice {
  Kernels doubles, floats;
  NearKernels near;
};

const Choice& best_kernels() {
  static const Choice chosen = []() -> Choice {
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq"))
      return {kernels_avx512(), kernels_avx512_floats(), kernels_avx512_near()};
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
      return {kernels_avx2(), kernels_avx2_floats(), kernels_avx2_near()};
#endif
    return {kernels_generic(), kernels_generic(), {}};
  }();
  return chosen;
}

bool is_off(const EffectInfo& e, const ParameterVector& v) {
  for (std::size_t j = 0; j < e.parameters.size(); ++j)
    if (e.parameters[j].switches && v[e.first + static_cast<int>(j)] != e.parameters[j].off) return false;
  return true;
}

// Which kernel a candidate needs, the cheapest that holds all that is not at its off value; only candidates of the same
// need share a pack.
enum class Need { base, extended, lined, corrected };
Need need_of(const ParameterVector& v) {
  Need need = Need::base;
  for (const EffectInfo& e : effect_list())
    if (!is_off(e, v))
      need = std::max(need, e.first == effect_row<Unexplained>(0)   ? Need::corrected
                            : e.first == effect_row<LineInertia>(0) ? Need::lined
                                                                    : Need::extended);
  return need;
}

RunPack run_of(const Kernels& k, Need need) {
  switch (need) {
    case Need::base:
      return k.base;
    case Need::extended:
      return k.extended;
    case Need::lined:
      return k.lined;
    case Need::corrected:
      return k.corrected;
  }
  return nullptr;
}

MakeRunInParts in_parts_of(const Kernels& k, Need need) {
  switch (need) {
    case Need::base:
      return k.base_in_parts;
    case Need::extended:
      return k.extended_in_parts;
    case Need::lined:
      return k.lined_in_parts;
    case Need::corrected:
      return k.corrected_in_parts;
  }
  return nullptr;
}

NearKernels::Make make_of(const NearKernels& k, Need need) {
  switch (need) {
    case Need::base:
      return k.base;
    case Need::extended:
      return k.extended;
    case Need::lined:  // a tap answers so fast that followers part from their run
    case Need::corrected:
      return nullptr;
  }
  return nullptr;
}

struct PackOfJobs {
  std::array<const Job*, 16> jobs;
  int count = 0;
  Need need = Need::base;
};

// Jobs of one log and one need share packs, wherever they stand. Longest logs first, so that no thread ends on a long
// one; the result does not depend on the order.
void pack(std::span<const Job> jobs, int width, std::vector<PackOfJobs>& packs) {
  thread_local std::vector<std::pair<const Job*, Need>> order;  // and its need
  order.clear();
  for (const Job& job : jobs) order.push_back({&job, need_of(*job.candidate)});
  const auto key = [](const std::pair<const Job*, Need>& j) {
    return std::tuple(-static_cast<long>(j.first->scenario->time.size()), j.first->scenario, j.second);
  };
  std::sort(order.begin(), order.end(), [&](const auto& a, const auto& b) {
    const auto of_a = key(a), of_b = key(b);
    return of_a != of_b ? of_a < of_b : a.first < b.first;
  });
  packs.clear();
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto [job, need] = order[i];
    if (i == 0 || key(order[i]) != key(order[i - 1]) || need == Need::corrected || packs.back().count == width)
      packs.push_back({{}, 0, need});
    packs.back().jobs[static_cast<std::size_t>(packs.back().count++)] = job;
  }
}

struct Request {
  std::span<const Job> jobs;
  SimulateOptions options;
};

// Whether the runs of one come out as the other's: all but the threads.
bool same_runs(const SimulateOptions& a, const SimulateOptions& b) {
  const auto what = [](const SimulateOptions& o) {
    return std::tie(o.step, o.impact_step, o.creep_step, o.wanted, o.arithmetic);
  };
  return what(a) == what(b);
}

std::atomic<long> packs_so_far = 0;
thread_local const Meeting<Request>::Ask* company = nullptr;  // of the task that runs in this thread

}  // namespace

int simulated_index(Signal s) {
  const auto it = std::find(simulated_signals.begin(), simulated_signals.end(), s);
  return it == simulated_signals.end() ? -1 : static_cast<int>(it - simulated_signals.begin());
}

void simulate(std::span<const Job> jobs, const SimulateOptions& options) {
  if (company) {
    Request request{jobs, options};
    return (*company)(request);
  }
  const Kernels& kernels =
      options.arithmetic == Arithmetic::floats ? best_kernels().floats : best_kernels().doubles;
  static const Kernels plain = kernels_scalar();
  thread_local std::vector<PackOfJobs> space;
  std::vector<PackOfJobs>& packs = space;
  pack(jobs, kernels.width, packs);
  const int threads = options.threads > 0 ? options.threads : omp_get_max_threads();
  const auto count = static_cast<long>(packs.size());
  packs_so_far += count;
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
  for (long k = 0; k < count; ++k) {
    const PackOfJobs& pack = packs[static_cast<std::size_t>(k)];
    const ParameterVector* candidates[16];
    Trajectory* results[16];
    for (int lane = 0; lane < pack.count; ++lane) {
      candidates[lane] = pack.jobs[static_cast<std::size_t>(lane)]->candidate;
      results[lane] = pack.jobs[static_cast<std::size_t>(lane)]->result;
    }
    // One alone runs in a lane too: eight cost hardly more, and the bits are the same in any company.
    run_of(pack.need == Need::corrected ? plain : kernels, pack.need)(*pack.jobs[0]->scenario, candidates, results,
                                                                      pack.count, options);
  }
}

namespace {

// From so many candidates on, a run that leads and the derivatives of its steps cost less than packs of eight:
// measured, 4.0 simulations for 4.1 with 25 to 32, 4.7 for 6.2 with 41 to 48, 3.1 for 3.1 with 24.
constexpr std::size_t least_followers = 25;

std::unique_ptr<NearRuns> near_runs(const NearJobs& near, const SimulateOptions& options) {
  if (near.jobs.size() < least_followers || near.jobs[0].scenario->ports != Ports::actuator) return nullptr;
  const NearKernels& kernels = best_kernels().near;
  Need need = need_of(*near.base);
  for (const Job& job : near.jobs) need = std::max(need, need_of(*job.candidate));
  const NearKernels::Make make = make_of(kernels, need);
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
  const bool floats = options.arithmetic == Arithmetic::floats;
  std::vector<std::unique_ptr<NearRuns>> runs(logs.size());
  if (!company)  // there, lanes that stand idle are another's
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
    for (long l = 0; l < n_logs; ++l) runs[l] = near_runs(logs[l], options);
  std::vector<Job> others;
  long ran = 0;
  for (std::size_t l = 0; l < logs.size(); ++l) {
    ran += static_cast<long>(logs[l].jobs.size()) + (runs[l] || floats);
    if (runs[l] || logs[l].jobs.empty()) continue;
    others.insert(others.end(), logs[l].jobs.begin(), logs[l].jobs.end());
    if (floats) others.push_back({logs[l].jobs.front().scenario, logs[l].base, logs[l].of_base});
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

void together(int tasks, int threads, const std::function<void(int)>& task) {
  const int at_a_time = threads > 0 ? threads : omp_get_max_threads();
  const auto serve = [&](const std::vector<Request*>& requests) {
    std::vector<char> served(requests.size(), 0);
    std::vector<Job> jobs;
    for (std::size_t i = 0; i < requests.size(); ++i) {
      if (served[i]) continue;
      SimulateOptions options = requests[i]->options;
      jobs.clear();
      for (std::size_t k = i; k < requests.size(); ++k) {
        if (served[k] || !same_runs(requests[k]->options, options)) continue;
        jobs.insert(jobs.end(), requests[k]->jobs.begin(), requests[k]->jobs.end());
        served[k] = 1;
      }
      options.threads = threads;
      simulate(jobs, options);
    }
  };
  Meeting<Request>::hold(
      tasks, at_a_time,
      [&](int i, const Meeting<Request>::Ask& ask) {
        company = &ask;
        omp_set_num_threads(1);  // of what this task does by itself
        task(i);
      },
      serve);
}

std::unique_ptr<RunInParts> run_in_parts(const Scenario& scenario, const ParameterVector& candidate, Trajectory& result,
                                         const SimulateOptions& options) {
  const Need need = need_of(candidate);
  static const Kernels plain = kernels_scalar();
  const Kernels& kernels = need == Need::corrected ? plain : best_kernels().doubles;
  return in_parts_of(kernels, need)(scenario, candidate, result, options);
}

Trajectory simulate(const Scenario& scenario, const ParameterVector& candidate, const SimulateOptions& options) {
  Trajectory t;
  const Job job{&scenario, &candidate, &t};
  simulate(std::span(&job, 1), options);
  return t;
}

std::string instruction_set() { return best_kernels().doubles.name; }
int pack_width() { return best_kernels().doubles.width; }
long packs_run() { return packs_so_far; }

}  // namespace servodx
