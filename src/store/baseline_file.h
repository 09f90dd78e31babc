// The file that `baseline` writes and `diagnose` reads: the result JSON of `baseline`, complete enough to judge with.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "diagnose/baseline.h"
#include "diagnose/diagnose.h"
#include "servodx/note.h"
#include "store/baseline_parts.h"

namespace servodx::store {

struct BaselineFile {
  DetectionBaseline baseline;
  std::string sha256;
  std::vector<Note> notes;
  std::string rig_file;  // that it was made with; empty: none
  std::optional<BaselineOf> of = {};
  bool has_causes = false;  // says what healthy logs show of each cause
};

// Throws InputError naming the file, the key, the rule and the mend.
BaselineFile read_baseline(const std::string& path);

}  // namespace servodx::store
