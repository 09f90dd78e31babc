#include "base/pack.h"
#include "effects/registry.h"
#include "simulate/kernels.h"
#include "simulate/run_in_parts_of.h"

namespace servodx {

Kernels kernels_avx512() {
  using T = Pack<8, 5>;
  return {T::lanes,
          "avx512",
          {kernel_of<T, NoEffects>(), kernel_of<T, CommonEffects>(), kernel_of<T, AllEffects>(),
           kernel_of<T, LinedEffects>(), kernel_avx512_corrected()}};
}

}  // namespace servodx
