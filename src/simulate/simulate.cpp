#include "simulate/simulate.h"

#include <omp.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "simulate/choose_kernel.h"
#include "simulate/company.h"
#include "simulate/kernels.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

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

std::atomic<long> packs_so_far = 0;

}  // namespace

void simulate(std::span<const Job> jobs, const SimulateOptions& options) {
  if (const auto* ask = company()) {
    RunRequest request{jobs, options};
    return (*ask)(request);
  }
  const bool floats = options.arithmetic == Arithmetic::floats;
  const Kernels& kernels = floats ? best_kernels().floats : best_kernels().doubles;
  const Kernels& plain = plain_kernels();
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

Trajectory simulate(const Scenario& scenario, const ParameterVector& candidate, const SimulateOptions& options) {
  Trajectory t;
  const Job job{&scenario, &candidate, &t};
  simulate(std::span(&job, 1), options);
  return t;
}

long packs_run() { return packs_so_far; }

}  // namespace servodx
