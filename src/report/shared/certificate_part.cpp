#include "report/shared/certificate_part.h"

#include <fmt/format.h>

#include "report/shared/handy.h"
#include "report/shared/json.h"
#include "report/shared/page.h"
#include "report/shared/page_head.h"
#include "report/shared/parts.h"
#include "report/shared/replay_part.h"
#include "servodx/certificate.h"
#include "servodx/log.h"

namespace servodx::report {

void add_to_head(PageHead& head, const Certificate& c) {
  head.say("Certificate", c.number);
  head.say("Issued", c.issued);
  head.say("Laboratory", c.laboratory);
  if (!c.customer.empty()) head.say("Customer", c.customer);
  head.say("Order", c.order);
  head.say("Valve", c.valve);
  if (!c.person.empty()) head.say("Operator", c.person);
  head.say("Place", c.place);
  head.say("Date", c.date);
  head.say("Method", c.method);
  head.say("Authorised by", c.authorised_by);
}

void add_certificate(Page& page, const CertificateOf& of, const Header& header,
                     const std::vector<CertifiedFigure>& figures, const std::string& rule) {
  const Certificate& certificate = *of.sheet;
  page.section("Certificate",
               "Uncertainties are expanded ones, k = 2, which covers about 95 %. The results are of the tested valve "
               "in the state in which it was tested.");
  TablePart certified{"Figures", "lrrll", {"figure", "value", "+- (k = 2)", "limit", ""}, {}, 0};
  for (const CertifiedFigure& f : figures) {
    Cell judgement = f.judgement;
    judgement.tone = f.tone;
    certified.rows.push_back({f.name, f.value, f.uncertainty, f.limit, judgement});
  }
  page.add(certified);
  page.text("Decision rule: " + rule);
  TablePart instruments{
      "Instruments", "llllll", {"instrument", "serial", "measures", "+- (k = 2)", "calibrated", "due"}, {}, 0};
  for (const Instrument& i : certificate.instruments) {
    Cell due = i.due;
    if (i.overdue(certificate.date)) due = i.due + ", overdue", due.tone = Tone::bad;
    instruments.rows.push_back({i.name, i.serial, i.error ? words(std::string(name_of(i.error->signal))) : "",
                                i.uncertainty, i.calibrated, due});
  }
  if (instruments.rows.empty())
    page.text("No instrument is named: uncertainties hold noise and resolution alone.");
  else
    page.add(instruments);
  TablePart inputs{"What it was made from", "ll", {"file", "SHA-256"}, {}, 0};
  for (const InputFile& file : header.inputs) inputs.rows.push_back({file.path, file.sha256});
  page.add(inputs);
  page.text(
      fmt::format("Made with servodx {}. This call makes it again, and says whether every bit is the same: "
                  "servodx rerun {}",
                  header.version, of.manifest));
}

}  // namespace servodx::report
