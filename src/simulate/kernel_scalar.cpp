#include "effects/registry.h"
#include "simulate/kernels.h"
#include "simulate/pack_run.h"
#include "simulate/run_in_parts_of.h"

namespace servodx {

Kernels kernels_scalar() {
  return {1,
          "scalar",
          &run_pack<double, NoEffects>,
          &run_pack<double, AllEffects>,
          &run_pack<double, LinedEffects>,
          &run_pack<double, CorrectedEffects>,
          &make_in_parts<double, NoEffects>,
          &make_in_parts<double, AllEffects>,
          &make_in_parts<double, LinedEffects>,
          &make_in_parts<double, CorrectedEffects>};
}

}  // namespace servodx
