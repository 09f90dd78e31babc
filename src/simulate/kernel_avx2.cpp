#include "base/pack.h"
#include "effects/registry.h"
#include "simulate/kernels.h"
#include "simulate/run_in_parts_of.h"

namespace servodx {

Kernels kernels_avx2() {
  using T = Pack<4, 2>;
  return {T::lanes,
          "avx2",
          {kernel_of<T, NoEffects>(), kernel_of<T, CommonEffects>(), kernel_of<T, AllEffects>(),
           kernel_of<T, LinedEffects>(), kernel_avx2_corrected()}};
}

}  // namespace servodx
