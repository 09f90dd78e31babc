// What to do about a verdict: one action a label, in a table that a shop may edit. The classes are those of "Fault
// Diagnosis of Electrohydraulic Systems", which diagnoses by a genetic algorithm and a simulation (docs/diagnosis.md).
#pragma once
#include <map>
#include <string>

namespace servodx {

// By urgency.
enum class ActionClass {
  none,      // go on
  abuse,     // the way it is used or set: change that
  abnormal,  // call service
  critical   // stop the machine
};
struct Action {
  ActionClass of = ActionClass::none;
  std::string text;  // "critical: stop the machine"
};
using Actions = std::map<std::string, Action>;  // by label; "healthy", "unknown" and "misread" among them

// Of a log of which the rig file or the wiring is to be mended, whatever its verdict is.
inline constexpr const char* misread_label = "misread";

// What the program says unless told.
Actions default_actions();
// The same with what a TOML file says in its place: clogged_filter = "abnormal: flush, then test again". Throws
// InputError with file, line and key for a label that is none, and for an action without a class.
Actions read_actions(const std::string& path);

}  // namespace servodx
