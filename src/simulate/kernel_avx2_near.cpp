#include "base/pack.h"
#include "effects/registry.h"
#include "simulate/kernels.h"
#include "simulate/run_and_followers.h"

namespace servodx {

NearKernels kernels_avx2_near() {
  using T = Pack<4, 2>;
  using F = Pack<2 * T::lanes, 2, float>;
  // None with long lines: a tap answers so fast that followers part from their run.
  return {{&RunAndFollowers<T, F, NoEffects>::make, &RunAndFollowers<T, F, CommonEffects>::make,
           &RunAndFollowers<T, F, AllEffects>::make}};
}

}  // namespace servodx
