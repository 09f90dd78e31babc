// What the facts of a rig file must agree in, and what follows from them: the actuator's areas from bore and rods, the
// fluid from its preset and the facts that override it.
#pragma once
#include "base/error.h"
#include "servodx/rig.h"

namespace servodx {

// Refuses a peak of the current beyond what amplifiers give; `at`: where it is stated. [fraction of rated current]
void require_drivable(double amplitude, const Place& at);

// Once all keys are read. Throws InputError where two facts contradict each other, or one lacks another.
void settle_facts(RigFile& rig);

}  // namespace servodx
