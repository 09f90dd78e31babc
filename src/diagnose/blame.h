// What a verdict asks to be looked at: a part of the valve, the model, what is around the valve, or another test.
//
// A fault that a record of the log tells by itself is of the sensor, the supply or the driver; every other is a
// component's. A state that no fault explains is missing physics where the search for it found a cause beyond what
// healthy logs show. Else the log does not tell, and another one may.
#pragma once

namespace servodx {

struct Diagnosis;

enum class Blame { none, component, physics, surroundings, test };

Blame blame_of(const Diagnosis& d);

}  // namespace servodx
