// The file that `baseline` writes and `diagnose` reads: the result JSON of `baseline`, complete enough to judge with.
#pragma once
#include <string>

#include "diagnose/diagnose.h"
#include "report/json.h"

namespace servodx::report {

struct BaselineFile {
  DetectionBaseline baseline;
  std::string sha256;
};

// Throws InputError naming the file, the key, the rule and the mend.
BaselineFile read_baseline(const std::string& path);

}  // namespace servodx::report
