// Fleets in words, JSON and pages: what a run over many logs did, and the table that its results make.
#pragma once
#include <optional>
#include <string>

#include "base/error.h"
#include "fleet/confusion.h"
#include "fleet/gather.h"
#include "fleet/run.h"
#include "report/shared/json.h"
#include "report/shared/page.h"
#include "servodx/fleet.h"

namespace servodx::report {

SetAside set_aside_of(const InputError& error);
std::string words_of(const SetAside& file);  // "log.csv:14: column 'time': rule; mend [E03]"

std::string text_of(const FleetRun& run);
Json fleet_run_json(const FleetRun& run);
std::string text_of(const CheckRun& run);
Json check_run_json(const CheckRun& run);
// The body of a result file of a log that was set aside.
Json refusal_json(const std::string& log, const InputError& error);

std::string text_of(const FleetTable& table, const std::optional<Confusion>& confusion);
Json fleet_json(const FleetTable& table, const std::optional<Confusion>& confusion);
// `results`: the folder as seen from where the page will stand; a row leads to its log's page there. Empty: no links.
Page fleet_page(const Header& header, const FleetTable& table, const std::optional<Confusion>& confusion,
                const std::string& results = "");

// The same of what gather_results() and count_fleet() made; null: no truth.
std::string text_of(const Fleet& fleet, const FleetCounts* counts);
Json fleet_json(const Fleet& fleet, const FleetCounts* counts);
Page fleet_page(const Header& header, const Fleet& fleet, const FleetCounts* counts, const std::string& results = "");

}  // namespace servodx::report
