// A history as CSV: one row a figure, an event or a tuned table, nothing left out; reading it back gives the same bits.
//
// Columns: kind (figure, event, table), valve, serial, at [h], cycles, name, value, std_error, unit, measured,
// expected, cause, oil_temperature [K], temperature_source, log, log_sha256, table_sha256, version, recorded_at, text.
// A figure's unit stands beside it. A check without figures has one row with an empty name.
//
// A history of another origin needs valve, at [h], name and value, in any order: without kind a row is a figure,
// without measured it is the value times expected, without expected 1, without a temperature 40 degC is assumed.
// oil_temperature may be in degC. Unknown columns are refused.
#pragma once
#include <string>

#include "store/history.h"

namespace servodx {

std::string history_csv(const HistoryContent& content);
// Throws InputError with file, line and column; nothing is returned half-read.
HistoryContent read_history_csv(const std::string& path);

}  // namespace servodx
