// What a verdict asks to be looked at: a part of the valve, the model, what is around the valve, how the log is read,
// or another test.
//
// A sensor whose sign is turned, two chambers exchanged and a log that was read wrongly are mended in the rig file or
// at the plugs, and so is a log whose columns no valve could have made: of the valve it says nothing until then.
// A fault that a record of the log tells by itself is of the sensor, the supply or the driver; every other is a
// component's. A state that no fault explains is what the search for missing physics found beyond healthy logs: of the
// model, or of a sensor or the driver. Else the log does not tell, and another one may.
#pragma once
#include <optional>

#include "diagnose/broken_sensors.h"

namespace servodx {

struct Diagnosis;

enum class Blame { none, component, physics, surroundings, log, test };

// Of a sensor that the verdict names as broken: how.
std::optional<SensorFinding> sensor_finding_of(const Diagnosis& d);

Blame blame_of(const Diagnosis& d);

}  // namespace servodx
