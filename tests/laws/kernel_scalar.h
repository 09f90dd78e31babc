// The runs in plain doubles, one lane: what every instruction set is held against.
#pragma once
#include "simulate/kernels.h"

namespace servodx {

Kernels kernels_scalar();

}  // namespace servodx
