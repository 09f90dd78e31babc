// A tune as text: whether it is good enough first, then channels, parameters and the search.
#pragma once
#include <string>

#include "report/shared/text_options.h"
#include "report/tune/tune_words.h"
#include "tune/tune.h"

namespace servodx::report {

std::string text_of(const TuneResult& result, const GoodEnough& good, const TextOptions& options);

}  // namespace servodx::report
