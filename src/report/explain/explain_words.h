// The words of an explanation's outcomes, for people and for programs.
#pragma once
#include <string>

#include "explain/outcome.h"
#include "explain/show.h"

namespace servodx::report {

const char* word_of(ExplainVerdict verdict);   // as JSON and text say it
const char* stamp_of(ExplainVerdict verdict);  // as a page opens with it
const char* word_of(ToldBy told_by);           // as JSON says it
const char* words_of_share(ToldBy told_by);    // after the share that a cause removes: of what; "" of the misfit
const char* words_of(Fate fate);               // why a candidate was not taken, or that it was
// "78 % of the excess sits within 30 ms of a reversal (21 % of the time)"
std::string words_of(const ExcessPlace& place);
const char* word_of(SizeTold told);            // as JSON says it
const char* words_of(SizeTold told);           // in place of an interval; "" where there is one

}  // namespace servodx::report
