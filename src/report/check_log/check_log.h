// `check-log` for a person, for a program, and as a page.
#pragma once
#include <optional>
#include <vector>

#include "report/shared/json.h"
#include "report/shared/page.h"
#include "servodx/check_log.h"

namespace servodx::report {

struct LogCheck {
  LogSurvey survey;
  std::optional<Promise> promise;   // where a table was given
  std::vector<double> time, drive;  // [s], [A] for the page
};

std::string text_of(const std::vector<LogCheck>& checks);
Json check_log_json(const std::vector<LogCheck>& checks);
// A part of a page: each fault at two sizes, and whether the log would show it.
void add_visible(Page& page, const std::vector<Visible>& faults);
Page check_log_page(const Header& header, const std::vector<LogCheck>& checks);

}  // namespace servodx::report
