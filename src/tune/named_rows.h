// The rows that the options of a tune name: `profile` and `priors`.
#pragma once
#include <string>

#include "servodx/tune.h"

namespace servodx {

// Throws InputError for a row that neither the list of rows nor an effect has.
void require_row_names(const TuneOptions& options);
// Whether its interval is to be checked by profile likelihood.
bool is_profiled(const std::string& row, const TuneOptions& options);
[[noreturn]] void refuse_prior(const std::string& row);

}  // namespace servodx
