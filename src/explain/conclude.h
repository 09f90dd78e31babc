// What is concluded from an answer: the verdict, the place, what an unnamed cause depends on, what stands first in logs
// that are like healthy ones, and how likely each cause is. No fit.
#pragma once
#include "explain/answer.h"
#include "explain/explain.h"
#include "explain/inquiry.h"

namespace servodx {

// Reads channels, blocks, places, causes and standing causes of `out`, and writes verdict, where, curve, depends_on,
// suspicion, p_adequacy, false_alarm and probabilities.
void conclude(const Inquiry& inquiry, const Answer& answer, ExplainResult& out);

}  // namespace servodx
