#include "base/pack.h"
#include "effects/registry.h"
#include "simulate/kernels.h"
#include "simulate/pack_run.h"

namespace servodx {

Kernels kernels_avx2_floats() {
  using T = Pack<8, 2, float>;
  return {T::lanes,
          "avx2",
          {{{&run_pack<T, NoEffects>},
            {&run_pack<T, CommonEffects>},
            {&run_pack<T, AllEffects>},
            {&run_pack<T, LinedEffects>}}}};
}

}  // namespace servodx
