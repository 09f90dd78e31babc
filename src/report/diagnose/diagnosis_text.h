// A verdict as text that a person reads in ten seconds: the verdict first, then what it rests on.
#pragma once
#include <string>

#include "diagnose/judge.h"
#include "report/shared/text_options.h"

namespace servodx::report {

std::string text_of(const Diagnosis& diagnosis, const TextOptions& options);

}  // namespace servodx::report
