// Runs candidates against logs: where the model's templates end. One run or many are the same code: candidates fill the
// lanes of packs, packs are spread over threads, and a lane equals the run alone bit for bit.
#pragma once
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "simulate/run_in_parts.h"
#include "simulate/scenario.h"

namespace servodx {

struct Job {
  const Scenario* scenario = nullptr;
  const ParameterVector* candidate = nullptr;  // n_candidate values
  Trajectory* result = nullptr;
};

// Runs all jobs. Neighbouring jobs of one scenario share packs. A candidate that diverges has ok = false; nothing
// throws.
void simulate(std::span<const Job> jobs, const SimulateOptions& options = {});
Trajectory simulate(const Scenario& scenario, const ParameterVector& candidate, const SimulateOptions& options = {});

// The same of a log that comes in parts, ready at the scenario's first sample, which is reported; the same bits. What
// it is given must live as long as it (run_in_parts.h).
std::unique_ptr<RunInParts> run_in_parts(const Scenario& scenario, const ParameterVector& candidate, Trajectory& result,
                                         const SimulateOptions& options);

// Candidates over one log that lie near `base`.
struct NearJobs {
  const ParameterVector* base = nullptr;
  std::span<const Job> jobs;
  Trajectory* of_base = nullptr;  // the base's run, where it was followed; left empty elsewhere
};
// The same to first order in how far they are off it, where so many run sooner that way (followers.h); on test
// stands, with a learnt curve and in company (together.h) runs of their own, as where they are few. Returns how many
// ran, bases that were followed included.
long simulate_near(std::span<const NearJobs> logs, const SimulateOptions& options);

int pack_width();
// Packs that this process has run so far: by it tests know that runs in company share packs.
long packs_run();

}  // namespace servodx
