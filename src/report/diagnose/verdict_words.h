// The words for what a diagnosis can come to: verdict, blame, hypothesis, gross finding, other reading, and why nothing
// could be judged. JSON, text and page take them from here.
#pragma once
#include <string>

#include "diagnose/blame.h"
#include "diagnose/decide.h"
#include "diagnose/judge.h"
#include "diagnose/judgeable.h"
#include "diagnose/reading.h"
#include "faults/fault.h"
#include "faults/gross_finding.h"

namespace servodx::report {

std::string word_of(VerdictKind verdict);    // healthy | fault | unknown
bool of_log(const Diagnosis& d);             // the log or the rig file is to be mended, not the valve
std::string headword(const Diagnosis& d);    // HEALTHY | FAULT | MISREAD, of columns or wiring | UNKNOWN
std::string word_of(Blame blame);            // none | component | physics | surroundings | log | test
std::string words_of(Blame blame);           // "a component failed"; "" of none
std::string word_of(GrossFinding finding);   // as JSON names it; "" of none
std::string words_of(GrossFinding finding);  // "" of none
std::string word_of(Misreading kind);
std::string word_of(Unjudgeable reason);    // one word, of no and of an unknown log alike what JSON says
std::string reason_of(const Diagnosis& d);  // one word: why it is unknown; "" where it is not
std::string words_of(const Reading& reading);
std::string words_of_doubt(const Diagnosis& d);   // why it is unknown, and what to look at; "" where it is not
std::string words_of(Unjudgeable reason);         // why there is nothing to judge, and what to look at; "" of no
std::string label_of(const Fault* hypothesis);    // its name; of null "healthy"
std::string name_of(const Diagnosis& d);          // the fault named, else the verdict
std::string action_label_of(const Diagnosis& d);  // by which the table of actions is asked
std::string meaning_of(const Fault* hypothesis);
std::string unit_of(const Fault* hypothesis);  // of its severity; "" of health

}  // namespace servodx::report
