#include "base/pack.h"
#include "effects/registry.h"
#include "simulate/kernels.h"
#include "simulate/pack_run.h"

namespace servodx {

Kernels kernels_avx512_floats() {
  using T = Pack<16, 5, float>;
  return {T::lanes,
          "avx512",
          {{{&run_pack<T, NoEffects>},
            {&run_pack<T, CommonEffects>},
            {&run_pack<T, AllEffects>},
            {&run_pack<T, LinedEffects>}}}};
}

}  // namespace servodx
