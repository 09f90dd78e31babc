// What a watched log gave, as a line of text and as JSON.
#pragma once
#include <string>

#include "online/alarm_limits.h"
#include "online/watcher.h"
#include "report/shared/json.h"

namespace servodx::report {

std::string text_of(const WatchEvent& event);  // one line; "" of a window, whose diagnosis is told instead
Json to_json(const WatchEvent& event);
Json to_json(const WatchLimits& limits);

}  // namespace servodx::report
