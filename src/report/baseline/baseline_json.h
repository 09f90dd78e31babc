// A baseline as JSON: the result of `baseline`, and the file that store/baseline_file.h reads back.
#pragma once
#include "diagnose/baseline.h"
#include "report/shared/json.h"

namespace servodx::report {

Json baseline_json(const DetectionBaseline& baseline);

}  // namespace servodx::report
