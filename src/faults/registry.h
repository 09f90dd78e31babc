// The visible list of faults: one file and one line each.
#pragma once
#include <string_view>
#include <vector>

#include "faults/fault.h"
#include "faults/record.h"

namespace servodx {

const std::vector<const Fault*>& fault_list();
const Fault* find_fault(std::string_view name);  // nullptr where unknown
const Fault* fault_told_by(Record record);       // nullptr where none is

}  // namespace servodx
