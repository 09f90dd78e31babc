// Where a log was taken: with an actuator, or on a test stand with its ports blocked or free, and what follows for its
// signals: which of them another one says already, and what a valve with free ports is fed with.
// Source: the definitions of SAE ARP490 and ISO 10770-1: leakage flow is measured with the ports blocked, control flow
// with the ports free.
#pragma once
#include <vector>

#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "simulate/scenario.h"

namespace servodx {

// The rig file's `ports`, or what the log itself says of a valve on a test stand; without leakage or control flow the
// rig file decides.
Ports ports_of(const Log& log, const RigFile& rig);
bool all_on_test_stand(const std::vector<Log>& logs, const RigFile& rig);

// What another channel of the log says already, or what was put in.
bool is_redundant(Signal which, const Log& log, Ports ports);

// Free ports: the valve is given its drop, as logged or as the data sheet rates its flow, where no supply was logged.
void take_valve_drop(Scenario& scenario, const Log& log, const RigFile& rig, std::vector<Note>& notes);

}  // namespace servodx
