// The runs as they are built for each instruction set, behind plain functions: who chooses among them
// (simulate/choose_kernel.h) needs none of their templates.
#pragma once
#include <array>
#include <cstddef>
#include <memory>

#include "simulate/run_in_parts.h"
#include "simulate/scenario.h"

namespace servodx {

using MakeRunInParts = std::unique_ptr<RunInParts> (*)(const Scenario&, const ParameterVector&, Trajectory&,
                                                       const SimulateOptions&);
using RunPack = void (*)(const Scenario&, const ParameterVector* const*, Trajectory* const*, int,
                         const SimulateOptions&);

// What a candidate has switched on, and so which effects its kernel carries (effects/registry.h).
enum class Need {
  base,
  common,     // those that fits keep on for long
  extended,   // all that have names but long lines
  lined,      // the common ones and long lines
  corrected,  // all, and a learnt curve of one place, variable and factor in all lanes
};
inline constexpr std::size_t n_needs = 5;

struct Kernel {
  RunPack run = nullptr;              // null: there is none
  MakeRunInParts in_parts = nullptr;  // the same of one candidate over a log that comes in parts
};
struct Kernels {
  int width;
  const char* name;
  std::array<Kernel, n_needs> of;
  const Kernel& operator[](Need need) const { return of[static_cast<std::size_t>(need)]; }
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
  std::array<Make, n_needs> of = {};  // null: there are none
  Make operator[](Need need) const { return of[static_cast<std::size_t>(need)]; }
};

Kernels kernels_generic();
Kernels kernels_avx2();
Kernels kernels_avx512();
// Those with a learnt curve have a translation unit of their own: an instance takes a minute to build.
Kernel kernel_generic_corrected();
Kernel kernel_avx2_corrected();
Kernel kernel_avx512_corrected();
// Twice as many lanes, of floats (Arithmetic).
Kernels kernels_avx2_floats();
Kernels kernels_avx512_floats();
NearKernels kernels_avx2_near();
NearKernels kernels_avx512_near();

}  // namespace servodx
