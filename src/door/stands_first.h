// What `explain` puts first, for commands that are not it.
#pragma once
#include "diagnose/judge.h"
#include "explain/explain.h"

namespace servodx {

// The cause that was taken, else what is suspected, else the place alone.
BeyondFaults stands_first(const ExplainResult& result);

}  // namespace servodx
