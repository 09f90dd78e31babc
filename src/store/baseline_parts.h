// What a Baseline of the front door carries: the limits that `diagnose` goes by, what healthy logs say of each cause,
// and its file.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "diagnose/baseline.h"
#include "explain/healthy.h"
#include "servodx/baseline.h"
#include "servodx/error.h"
#include "signals/rig_content.h"

namespace servodx {

// What the healthy logs were read by and hold.
struct BaselineOf {
  RigStatements rig;
  std::vector<std::string> signals;  // that every log holds
};

struct BaselineParts {
  DetectionBaseline detection;
  std::optional<HealthyReference> causes;    // earlier versions wrote none
  std::optional<InputError> causes_refused;  // why not, where the file was read
  std::string rig_file;                      // that it was made with; empty: none
  std::optional<BaselineOf> of;              // earlier versions wrote none
  std::string text;                          // of the file
  std::string sha256;                        // of that text
};

// Throws InputError where there is nothing in it: a Baseline is made or read.
const BaselineParts& parts_of(const Baseline& baseline);
// Throws InputError where the file says nothing of causes: `explain` needs it, `diagnose` does not.
const HealthyReference& causes_of(const Baseline& baseline);

}  // namespace servodx
