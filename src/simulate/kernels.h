// The runs as they are built for each instruction set, behind plain functions: who chooses among them
// (simulate/choose_kernel.h) needs none of their templates.
#pragma once
#include <memory>

#include "simulate/run_in_parts.h"
#include "simulate/scenario.h"

namespace servodx {

using MakeRunInParts = std::unique_ptr<RunInParts> (*)(const Scenario&, const ParameterVector&, Trajectory&,
                                                       const SimulateOptions&);
using RunPack = void (*)(const Scenario&, const ParameterVector* const*, Trajectory* const*, int,
                         const SimulateOptions&);

struct Kernels {
  int width;
  const char* name;
  RunPack base, extended;  // without effects, with all that have names but long lines
  RunPack lined;           // with these too
  RunPack corrected;       // with a learnt curve too, of one place, variable and factor in all lanes; null: no such
  // One candidate over a log that comes in parts, the same four.
  MakeRunInParts base_in_parts = nullptr, extended_in_parts = nullptr, lined_in_parts = nullptr,
                 corrected_in_parts = nullptr;
};
// A run, and candidates near it that follow its steps (run_and_followers.h). It leads by a stretch of samples; they
// follow over the one before the last turn.
class NearRuns {
 public:
  virtual ~NearRuns() = default;
  virtual int followers() const = 0;      // packs of candidates
  virtual bool lead(int steps) = 0;       // to the sample behind so many; false at the end of the run
  virtual void follow(int follower) = 0;  // any order, any thread, beside `lead`
  virtual void turn() = 0;                // alone, between stretches
  virtual void end() = 0;                 // alone, at last: a run that failed takes its followers along
};
struct NearKernels {
  using Make = std::unique_ptr<NearRuns> (*)(const Scenario&, const ParameterVector& base, Trajectory& of_base,
                                             const ParameterVector* const*, Trajectory* const*, int,
                                             const SimulateOptions&);
  Make base = nullptr, extended = nullptr;  // null: there are none
};

// Those with a learnt curve have a translation unit of their own: an instance takes a minute to build.
struct CorrectedKernels {
  RunPack run;
  MakeRunInParts in_parts;
};

Kernels kernels_generic();
Kernels kernels_avx2();
Kernels kernels_avx512();
CorrectedKernels kernels_generic_corrected();
CorrectedKernels kernels_avx2_corrected();
CorrectedKernels kernels_avx512_corrected();
// Twice as many lanes, of floats (Arithmetic).
Kernels kernels_avx2_floats();
Kernels kernels_avx512_floats();
NearKernels kernels_avx2_near();
NearKernels kernels_avx512_near();

}  // namespace servodx
