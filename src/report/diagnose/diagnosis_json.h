// Verdicts as JSON, to stand behind the header's keys.
#pragma once
#include <vector>

#include "diagnose/assessment.h"
#include "diagnose/judge.h"
#include "report/shared/json.h"
#include "servodx/diagnose.h"

namespace servodx::report {

Json to_json(const HypothesisResult& hypothesis);
Json to_json(const Diagnosis& diagnosis);
Json diagnose_json(const std::vector<Diagnosis>& results);
// None of them interrupted.
Json diagnose_json(const std::vector<servodx::Verdict>& verdicts);

}  // namespace servodx::report
