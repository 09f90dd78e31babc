// How a result is written as text for a terminal.
#pragma once
#include <string>

#include "report/shared/call_names.h"

namespace servodx::report {

struct TextOptions {
  bool colour = false;     // the verdict's word, for a terminal
  std::string written_to;  // the command's output file, if any
  CallNames call = {};     // of the calls that are advised
};

}  // namespace servodx::report
