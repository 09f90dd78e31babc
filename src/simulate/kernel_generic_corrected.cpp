#include "base/pack.h"
#include "effects/registry.h"
#include "simulate/kernels.h"
#include "simulate/run_in_parts_of.h"

namespace servodx {

Kernel kernel_generic_corrected() { return kernel_of<Pack<2, 0>, CorrectedEffects>(); }

}  // namespace servodx
