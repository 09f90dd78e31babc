// `explain` for people and for programs, and what a baseline keeps for it.
#pragma once
#include <string>

#include "explain/explain.h"
#include "explain/healthy.h"
#include "report/shared/json.h"
#include "report/shared/page.h"
#include "report/shared/text_options.h"
#include "servodx/replay.h"

namespace servodx::report {

Json explain_json(const ExplainResult& result);
// `replays`: of some of the logs, as tuned and with the causes.
Page explain_page(const Header& header, const ExplainResult& result, const std::vector<Replay>& replays);
// "20.3 um (19.9 to 20.6, 90 %)", "148 kg, not determined by these logs".
std::string size_in_words(const ExplainedParameter& size);
// What stands first though the simulation suffices.
std::string suspicion_in_words(const ExplainSuspicion& suspicion);
std::string rate_in_words(const ExplainedFalseAlarm& rate);
// "missing at piston_force: 310 N rms, ..."; empty where nothing is wrong: no valve is its model, and a healthy one
// misses something too.
std::string missing_in_words(const ExplainResult& result);
std::string text_of(const ExplainResult& result, const TextOptions& options);

// The part of a baseline file that `explain` reads, under the key "explain".
Json healthy_json(const HealthyReference& healthy);

}  // namespace servodx::report
