// The front door of `curves`.
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <utility>

#include "base/require_setting.h"
#include "curves/curves.h"
#include "curves/frequency_response.h"
#include "report/curves/curves.h"
#include "servodx/curves.h"
#include "servodx/log.h"
#include "servodx/rig.h"

namespace servodx {
namespace {

bool is_size(double x) { return std::isfinite(x) && x >= 0; }

}  // namespace

void SheetOptions::validate() const {
  require_setting(is_size(guard), "SheetOptions.guard", fmt::format("{} is no guard band", guard),
                  "give it in expanded uncertainties: 1, or 0 for simple acceptance");
  for (const InstrumentError& e : instruments)
    require_setting(is_size(e.absolute) && is_size(e.relative), "SheetOptions.instruments",
                    fmt::format("the uncertainty of '{}' is negative or no number", name_of(e.signal)),
                    "give its size");
}

AcceptanceSheet acceptance_sheet(const Log& log, const Rig& rig, const SheetOptions& options) {
  options.validate();
  curves::Sheet sheet = curves::read_curves(log, rig, options);
  AcceptanceSheet out;
  out.whole = std::make_shared<curves::Sheet>(sheet);
  for (const curves::Figure& f : sheet.figures)
    out.figures.push_back(
        {f.name, f.signal, f.value, f.unit, f.uncertainty, f.limit, f.pass(), report::words_of(f.remark)});
  for (curves::SweepCurve& c : sheet.curves)
    out.curves.push_back({c.signal, std::move(c.current), std::move(c.up), std::move(c.down), std::move(c.mean)});
  for (const curves::ResponsePoint& p : sheet.response)
    out.response.push_back({p.frequency, p.gain, p.phase, p.coherence});
  out.response_signal = std::move(sheet.response_signal);
  out.notes = std::move(sheet.notes);
  out.kind = sheet.verdict;
  return out;
}

}  // namespace servodx
