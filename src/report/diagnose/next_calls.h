// The calls of the program that a diagnosis advises, with the names of the files that it was given.
#pragma once
#include <string>
#include <vector>

#include "diagnose/judge.h"
#include "report/shared/call_names.h"

namespace servodx::report {

// The input that would separate the fault named from what it is ambiguous with. "" where none.
std::string separating_test_of(const Diagnosis& d, const CallNames& names = {});
// Of a verdict that names nothing: what to run next.
std::vector<std::string> next_calls(const Diagnosis& d, const CallNames& names = {});

}  // namespace servodx::report
