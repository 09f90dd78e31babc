#include "simulate/simulate.h"

#include <omp.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <span>
#include <tuple>
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

struct KindOfJob {
  const Job* job;
  Need need;
  int curve;  // 0 where it has none
};

// Floats are for ranking, and no learnt curve is ranked so often that it needs them.
const Kernels& kernels_of(Need need, Arithmetic arithmetic) {
  const bool floats = arithmetic == Arithmetic::floats && need != Need::corrected;
  return floats ? best_kernels().floats : best_kernels().doubles;
}

// Jobs of one log and one kind share packs, wherever they stand. Longest logs first, so that no thread ends on a long
// one; the result does not depend on the order.
void pack(std::span<const Job> jobs, Arithmetic arithmetic, std::vector<PackOfJobs>& packs) {
  thread_local std::vector<KindOfJob> order;
  order.clear();
  for (const Job& job : jobs) {
    const Need need = need_of(*job.candidate);
    order.push_back({&job, need, need == Need::corrected ? curve_kind(*job.candidate) : 0});
  }
  const auto key = [](const KindOfJob& j) {
    return std::tuple(-static_cast<long>(j.job->scenario->time.size()), j.job->scenario, j.need, j.curve);
  };
  std::sort(order.begin(), order.end(), [&](const auto& a, const auto& b) {
    const auto of_a = key(a), of_b = key(b);
    return of_a != of_b ? of_a < of_b : a.job < b.job;
  });
  packs.clear();
  for (std::size_t i = 0; i < order.size(); ++i) {
    const int width = kernels_of(order[i].need, arithmetic).width;
    if (i == 0 || key(order[i]) != key(order[i - 1]) || packs.back().count == width)
      packs.push_back({{}, 0, order[i].need});
    packs.back().jobs[static_cast<std::size_t>(packs.back().count++)] = order[i].job;
  }
}

std::atomic<long> packs_so_far = 0;

}  // namespace

void simulate(std::span<const Job> jobs, const SimulateOptions& options) {
  if (const auto* ask = company()) {
    RunRequest request{jobs, options};
    return (*ask)(request);
  }
  thread_local std::vector<PackOfJobs> space;
  std::vector<PackOfJobs>& packs = space;
  pack(jobs, options.arithmetic, packs);
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
    const Kernels& kernels = kernels_of(pack.need, options.arithmetic);
    kernels[pack.need].run(*pack.jobs[0]->scenario, candidates, results, pack.count, options);
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
