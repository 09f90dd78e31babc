// The acceptance sheet of `servodx curves` as text, JSON, a picture and a page.
#pragma once
#include <string>

#include "curves/curves.h"
#include "report/shared/certificate_part.h"
#include "report/shared/json.h"
#include "report/shared/page.h"
#include "servodx/curves.h"
#include "servodx/data_sheet.h"

namespace servodx::report {

// A figure's value, and its limit, as a test engineer reads them.
std::string readable(const curves::Figure& figure, double value, int significant = 4);
std::string limit_text(const curves::Figure& figure);
std::string value_text(const curves::Figure& figure);        // "-" where the log cannot tell
std::string uncertainty_text(const curves::Figure& figure);  // "" where it is not known
std::string word_of(curves::Judgement judgement);            // "" of what is not judged
std::string judgement_of(const curves::Figure& figure);      // says so of a figure that has a limit
std::string words_of(const curves::Remark& remark);          // "" where there is none
std::string guard_words(double guard);                       // the decision rule
std::string word_of(AcceptanceSheet::Kind verdict);          // "PASS"
std::string limits_in_words(const curves::Sheet& sheet);     // how many of how many limits are kept, and why not

std::string text_of(const curves::Sheet& sheet, const std::string& log, bool colour);
Json curves_json(const curves::Sheet& sheet);
std::string curves_svg(const curves::Sheet& sheet, double rated_current);
Page curves_page(const Header& header, const curves::Sheet& sheet, const std::string& log, double rated_current,
                 double guard, const CertificateOf& certificate = {}, const SheetFit* stated = nullptr);

}  // namespace servodx::report
