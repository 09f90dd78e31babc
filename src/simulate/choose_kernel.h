// Which kernel runs a candidate: of the instruction sets the widest that the processor has, or the one that the
// environment's SERVODX_INSTRUCTION_SET names; of the effects the fewest that hold all that the candidate has switched
// on. Chosen at run time; instruction sets agree to 1e-7 of a signal's range, not to the bit (docs/decisions.md).
#pragma once
#include "simulate/kernels.h"
#include "simulate/scenario.h"

namespace servodx {

struct Choice {
  Kernels doubles, floats;
  NearKernels near;
};
// Throws InputError where an instruction set is asked for that is unknown or that the processor lacks.
const Choice& best_kernels();

// The cheapest kernel that holds all that is not at its off value; only candidates of the same need share a pack.
Need need_of(const ParameterVector& candidate);
// Of a corrected candidate, one number for the place of its curve, its variable and its factor: lanes have them alike.
int curve_kind(const ParameterVector& candidate);

}  // namespace servodx
