#include "base/pack.h"
#include "effects/registry.h"
#include "simulate/kernels.h"
#include "simulate/run_in_parts_of.h"

namespace servodx {

Kernels kernels_generic() {
  using T = Pack<2, 0>;
  return {T::lanes,
          "generic",
          {kernel_of<T, NoEffects>(), kernel_of<T, CommonEffects>(), kernel_of<T, AllEffects>(),
           kernel_of<T, LinedEffects>(), kernel_generic_corrected()}};
}

}  // namespace servodx
