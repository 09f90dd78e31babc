#include "base/pack.h"
#include "effects/registry.h"
#include "simulate/kernel.h"

namespace servodx {

Kernels kernels_generic() {
  using T = Pack<2, 0>;
  return {T::lanes, "generic", &run_pack<T, NoEffects>, &run_pack<T, AllEffects>, nullptr};
}

}  // namespace servodx
