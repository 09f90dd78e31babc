#include "simulate/together.h"

#include <omp.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <tuple>
#include <vector>

#include "base/meeting.h"
#include "simulate/company.h"
#include "simulate/scenario.h"
#include "simulate/simulate.h"

namespace servodx {
namespace {

// Whether the runs of one come out as the other's: all but the threads.
bool same_runs(const SimulateOptions& a, const SimulateOptions& b) {
  const auto what = [](const SimulateOptions& o) {
    return std::tie(o.step, o.impact_step, o.creep_step, o.wanted, o.arithmetic);
  };
  return what(a) == what(b);
}

struct CalledOff {};

thread_local const Meeting<RunRequest>::Ask* mine = nullptr;  // of the task that runs in this thread

}  // namespace

const Meeting<RunRequest>::Ask* company() { return mine; }

void together(int tasks, int threads, const std::function<void(int)>& task, const std::function<bool()>& go_on) {
  const int at_a_time = threads > 0 ? threads : omp_get_max_threads();
  const auto serve = [&](const std::vector<RunRequest*>& requests) {
    if (go_on && !go_on()) throw CalledOff{};
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
  try {
    Meeting<RunRequest>::hold(
        tasks, at_a_time,
        [&](int i, const Meeting<RunRequest>::Ask& ask) {
          mine = &ask;
          omp_set_num_threads(1);  // of what this task does by itself
          task(i);
        },
        serve);
  } catch (const CalledOff&) {  // what is done is done
  }
}

void fits_together(int fits, std::size_t samples, int threads, const std::function<void(int)>& fit,
                   const std::function<bool()>& go_on) {
  constexpr std::size_t samples_at_once = 1'000'000;  // a fit keeps some 1.4 kB a sample
  const auto group = static_cast<int>(std::max<std::size_t>(2, samples_at_once / std::max<std::size_t>(1, samples)));
  for (int first = 0; first < fits && (!go_on || go_on()); first += group)
    together(
        std::min(group, fits - first), threads, [&](int i) { fit(first + i); }, go_on);
}

}  // namespace servodx
