// What a data sheet states of a valve's dynamics beside what the table's valve does: text, JSON and a page's section.
#pragma once
#include <string>

#include "report/shared/json.h"
#include "report/shared/page.h"
#include "servodx/data_sheet.h"

namespace servodx::report {

std::string text_of(const SheetFit& sheet);
Json data_sheet_json(const SheetFit& sheet);
void add_data_sheet(Page& page, const SheetFit& sheet);
// The sheet by itself, where no log was given.
Page data_sheet_page(const Header& header, const SheetFit& sheet);

}  // namespace servodx::report
