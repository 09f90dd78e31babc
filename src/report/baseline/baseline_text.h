// A baseline as text: its threshold first, then the scores that set it.
#pragma once
#include <string>

#include "diagnose/baseline.h"
#include "report/shared/text_options.h"
#include "servodx/baseline.h"

namespace servodx::report {

std::string text_of(const DetectionBaseline& baseline, const TextOptions& options);
std::string text_of(const Baseline& baseline, const TextOptions& options);

}  // namespace servodx::report
