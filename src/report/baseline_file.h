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

// Refuses a baseline that was made with another table than the one of this path and hash: its threshold is a statement
// about that table's residuals.
void require_same_table(const DetectionBaseline& baseline, const std::string& baseline_path,
                        const std::string& table_path, const std::string& table_sha256);

}  // namespace servodx::report
