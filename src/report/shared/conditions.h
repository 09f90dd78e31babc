// Where a log was recorded, for a person, for a program, and as a part of a page.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "report/shared/json.h"
#include "report/shared/page.h"
#include "report/shared/page_head.h"
#include "servodx/log.h"
#include "servodx/operating_point.h"
#include "signals/signal.h"

namespace servodx::report {

// "supply 139 bar, oil 41 degC, drive up to 9.2 mA": what the log holds.
std::string conditions_in_words(const std::vector<ConditionRow>& rows);
// "load up to 7.48 kN (fault-free logs 24 N to 4.58 kN)": what is beyond; empty where nothing is.
std::string beyond_in_words(const std::vector<ConditionRow>& rows);
// "supply 207 bar, oil 38 to 42 degC": what the logs that tuned the table show; empty where they are not known.
std::string tuned_in_words(const std::vector<ConditionRow>& rows);
Json conditions_json(const std::vector<ConditionRow>& rows);
void add_conditions(Page& page, const std::vector<ConditionRow>& rows);
// What the log holds, one by one; `signal`: that it was read from.
struct ConditionFigure {
  std::string name, value;
  std::optional<Signal> signal;
};
std::vector<ConditionFigure> condition_figures(const std::vector<ConditionRow>& rows);
// Oil and supply of the test, into the page's head.
// Oil and supply of these logs, "208 bar to 210 bar" of several.
void add_to_head(PageHead& head, const std::vector<Log>& logs);
void add_to_head(Page& page, const std::vector<ConditionRow>& rows);

}  // namespace servodx::report
