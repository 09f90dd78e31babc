#include "base/pack.h"
#include "effects/registry.h"
#include "simulate/kernels.h"
#include "simulate/pack_run.h"
#include "simulate/run_in_parts_of.h"

namespace servodx {

Kernels kernels_avx2() {
  const CorrectedKernels corrected = kernels_avx2_corrected();
  using T = Pack<4, 2>;
  return {T::lanes,
          "avx2",
          &run_pack<T, NoEffects>,
          &run_pack<T, AllEffects>,
          &run_pack<T, LinedEffects>,
          corrected.run,
          &make_in_parts<T, NoEffects>,
          &make_in_parts<T, AllEffects>,
          &make_in_parts<T, LinedEffects>,
          corrected.in_parts};
}

}  // namespace servodx
