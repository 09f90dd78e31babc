#include "simulate/simulate.h"

#include <omp.h>

#include <algorithm>
#include <cmath>

#include "simulate/kernel.h"

namespace servodx {
namespace {

struct Choice {
  Kernels doubles, ranking;
};

const Choice& best_kernels() {
  static const Choice chosen = []() -> Choice {
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq"))
      return {kernels_avx512(), kernels_avx512_floats()};
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return {kernels_avx2(), kernels_avx2_floats()};
#endif
    return {kernels_generic(), kernels_generic()};
  }();
  return chosen;
}

bool is_off(const EffectInfo& e, const ParameterVector& v) {
  for (std::size_t j = 0; j < e.parameters.size(); ++j)
    if (e.parameters[j].switches && v[e.first + static_cast<int>(j)] != e.parameters[j].off) return false;
  return true;
}

// Which kernel a candidate needs, the cheapest that holds all that is not at its off value; only candidates of the same
// need share a pack. 0: none of the effects; 1: effects that have a name; 2: a learnt curve, which runs alone.
int need_of(const ParameterVector& v) {
  int need = 0;
  for (const EffectInfo& e : effect_list()) {
    if (is_off(e, v)) continue;
    if (e.name != Unexplained::name) {
      need = std::max(need, 1);
      continue;
    }
    need = 2;
  }
  return need;
}

RunPack run_of(const Kernels& k, int need) { return need == 0 ? k.base : need == 1 ? k.extended : k.corrected; }

struct PackOfJobs {
  std::size_t first = 0;
  int count = 0;
  int need = 0;
};

}  // namespace

int simulated_index(Signal s) {
  const auto it = std::find(simulated_signals.begin(), simulated_signals.end(), s);
  return it == simulated_signals.end() ? -1 : static_cast<int>(it - simulated_signals.begin());
}

void simulate(std::span<const Job> jobs, const SimulateOptions& options) {
  const Kernels& kernels = options.ranking ? best_kernels().ranking : best_kernels().doubles;
  static const Kernels plain = kernels_scalar();
  std::vector<PackOfJobs> packs;
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    const int need = need_of(*jobs[i].candidate);
    if (!packs.empty() && packs.back().count < kernels.width && packs.back().need == need && need < 2 &&
        jobs[packs.back().first].scenario == jobs[i].scenario)
      ++packs.back().count;
    else
      packs.push_back({i, 1, need});
  }
  // Longest logs first, so that no thread ends on a long one; the result does not depend on the order.
  std::vector<std::size_t> order(packs.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return jobs[packs[a].first].scenario->time.size() > jobs[packs[b].first].scenario->time.size();
  });
  const int threads = options.threads > 0 ? options.threads : omp_get_max_threads();
  const auto count = static_cast<long>(packs.size());
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
  for (long k = 0; k < count; ++k) {
    const PackOfJobs& pack = packs[order[k]];
    const ParameterVector* candidates[16];
    Trajectory* results[16];
    for (int lane = 0; lane < pack.count; ++lane) {
      candidates[lane] = jobs[pack.first + lane].candidate;
      results[lane] = jobs[pack.first + lane].result;
    }
    const Scenario& scenario = *jobs[pack.first].scenario;
    // One alone runs in a lane too: eight cost hardly more, and the bits are the same in any company.
    run_of(pack.need == 2 ? plain : kernels, pack.need)(scenario, candidates, results, pack.count, options);
  }
}

Trajectory simulate(const Scenario& scenario, const ParameterVector& candidate, const SimulateOptions& options) {
  Trajectory t;
  const Job job{&scenario, &candidate, &t};
  simulate(std::span(&job, 1), options);
  return t;
}

std::string instruction_set() { return best_kernels().doubles.name; }
int pack_width() { return best_kernels().doubles.width; }

}  // namespace servodx
