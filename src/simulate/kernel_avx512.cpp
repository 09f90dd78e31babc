#include "base/pack.h"
#include "effects/registry.h"
#include "simulate/kernel.h"

namespace servodx {

Kernels kernels_avx512() {
  using T = Pack<8, 5>;
  return {T::lanes, "avx512", &run_pack<T, NoEffects>, &run_pack<T, AllEffects>, nullptr};
}

}  // namespace servodx
