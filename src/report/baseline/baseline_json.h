// A baseline as JSON: the result of `baseline`, and the file that store/baseline_file.h reads back.
#pragma once
#include "diagnose/baseline.h"
#include "report/shared/json.h"
#include "servodx/baseline.h"
#include "store/baseline_parts.h"

namespace servodx::report {

Json baseline_json(const DetectionBaseline& baseline);
// All of it: with what healthy logs say of each cause.
Json baseline_json(const BaselineParts& parts);
Json baseline_json(const Baseline& baseline);

}  // namespace servodx::report
