// The certificate of a test on a page: what its sheet says (servodx/certificate.h) beside the result.
#pragma once
#include <string>
#include <vector>

#include "report/shared/json.h"
#include "report/shared/page.h"
#include "report/shared/page_head.h"
#include "report/shared/parts.h"
#include "servodx/certificate.h"

namespace servodx::report {

// A certificate that is asked for, and the manifest by which its result is made again.
struct CertificateOf {
  const Certificate* sheet = nullptr;  // null: none
  std::string manifest;
};

// Customer, date and number into the page's head.
void add_to_head(PageHead& head, const Certificate& certificate);

// What is certified, a figure a row.
struct CertifiedFigure {
  std::string name, value, uncertainty, limit;
  std::string judgement = {};
  Tone tone = Tone::plain;
};

// The section of the page: figures, rule, instruments, inputs by their hash, and the call that makes it again.
void add_certificate(Page& page, const CertificateOf& certificate, const Header& header,
                     const std::vector<CertifiedFigure>& figures, const std::string& rule);

}  // namespace servodx::report
