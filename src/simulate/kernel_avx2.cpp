#include "base/pack.h"
#include "effects/registry.h"
#include "simulate/kernel.h"

namespace servodx {

Kernels kernels_avx2() {
  using T = Pack<4, 2>;
  return {T::lanes, "avx2", &run_pack<T, NoEffects>, &run_pack<T, AllEffects>, nullptr};
}

}  // namespace servodx
