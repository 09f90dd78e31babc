// What text and page of a fleet say in the same words.
#pragma once
#include <string>

#include "fleet/confusion.h"
#include "fleet/gather.h"
#include "report/shared/json.h"
#include "report/shared/parts.h"

namespace servodx::report {

std::string fleet_headline(const FleetTable& table);  // "400 logs: 380 healthy, 15 fault, 5 unknown; 2 set aside"
std::string severity_words(const FleetRow& row);      // "" where the verdict has no size
// Of a fault alone: of health it would promise more than a baseline can, of an unknown state it says nothing.
std::string probability_words(const FleetRow& row);
std::string rate_words(const CountedRate& rate);  // "19 of 20, 95 % (76 % to 99 %)"
Cell rate_cell(const CountedRate& rate);          // the same; blank where nothing was counted
Json rate_json(const CountedRate& rate);
long count_of(const Confusion& confusion, const std::string& label, const std::string& name);

}  // namespace servodx::report
