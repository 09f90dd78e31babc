#include "laws/kernel_scalar.h"

#include "effects/registry.h"
#include "simulate/pack_run.h"

namespace servodx {

Kernels kernels_scalar() {
  return {1,
          "scalar",
          {{{&run_pack<double, NoEffects>},
            {&run_pack<double, CommonEffects>},
            {&run_pack<double, AllEffects>},
            {&run_pack<double, LinedEffects>},
            {&run_pack<double, CorrectedEffects>}}}};
}

}  // namespace servodx
