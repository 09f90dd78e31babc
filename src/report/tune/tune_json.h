// The result of `tune` as JSON, to stand behind the header's keys.
#pragma once
#include "report/shared/json.h"
#include "tune/tune.h"

namespace servodx::report {

Json tune_json(const TuneResult& result);

}  // namespace servodx::report
