// Threads of OpenMP that wait for each other spin, and where other programs want the cores they spin in the others'
// time: a tune then takes seven times as long. libgomp reads how long to spin as it is loaded, before main().
#pragma once

namespace servodx {

// Makes the threads of this program sleep after a moment of waiting: sets the variable that libgomp reads and begins the
// program anew, once. Leaves everything as it is where the environment says how to wait, on one core, and where the
// program cannot be begun anew.
void sleep_while_waiting(char** argv);

}  // namespace servodx
