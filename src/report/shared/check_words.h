// A check of a valve and its size, as the pages of `check` and `trend` say them.
#pragma once
#include <string>

#include "prognose/check_name.h"
#include "report/shared/handy.h"

namespace servodx::report {

// "clogged filter (row 1)", and the paper's checks by their symbols.
std::string name_of_check(const CheckName& check, const std::string& cause);
// A part lost (of the filter's area) reads as per cent.
HandyUnit unit_of_check(const std::string& unit, const std::string& cause, double magnitude);
std::string size_of_check(const std::string& unit, const std::string& cause, double value);
template <class Check>
std::string size_of_check(const Check& check, double value) {
  return size_of_check(check.unit, check.cause, value);
}

}  // namespace servodx::report
