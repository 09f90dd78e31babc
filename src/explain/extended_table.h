// The tuned table with what was found: re-tuned rows, and rows of the causes' own.
#pragma once
#include <vector>

#include "explain/engine.h"
#include "explain/explain.h"
#include "explain/valve.h"
#include "parameters/table.h"

namespace servodx {

// `causes` describe those of `found`, in order.
Table extended_table(const ValveSubject& subject, const FoundCauses& found, const std::vector<ExplainedCause>& causes);

}  // namespace servodx
