#include "effects/registry.h"
#include "simulate/kernel.h"

namespace servodx {

Kernels kernels_scalar() {
  return {1, "scalar", &run_pack<double, NoEffects>, &run_pack<double, AllEffects>,
          &run_pack<double, CorrectedEffects>};
}

}  // namespace servodx
