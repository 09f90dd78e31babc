#include "base/pack.h"
#include "effects/registry.h"
#include "simulate/kernels.h"
#include "simulate/pack_run.h"
#include "simulate/run_in_parts_of.h"

namespace servodx {

CorrectedKernels kernels_generic_corrected() {
  using T = Pack<2, 0>;
  return {&run_pack<T, CorrectedEffects>, &make_in_parts<T, CorrectedEffects>};
}

}  // namespace servodx
