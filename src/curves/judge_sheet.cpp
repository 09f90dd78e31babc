#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "curves/curves.h"
#include "servodx/curves.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "signals/rig_keys.h"

namespace servodx::curves {
namespace {

// By its size, as limits are.
Judgement judged(const Figure& f, const Limit& limit, double guard) {
  const double size = std::fabs(f.value), band = guard > 0 ? guard * f.uncertainty : 0.0;
  if (!std::isfinite(size) || !std::isfinite(band)) return Judgement::not_judged;
  if ((limit.min && !(size > *limit.min)) || (limit.max && !(size < *limit.max))) return Judgement::fail;
  const bool inside = (!limit.min || size - band > *limit.min) && (!limit.max || size + band < *limit.max);
  return inside ? Judgement::pass : Judgement::too_near;
}

Figure not_shown(const std::string& name, const Limit& limit) {
  Figure f;
  f.name = name;
  f.value = std::nan("");
  f.remark = {Remark::Kind::not_shown};
  f.limit = limit;
  for (const LimitInfo& known : limit_list())
    if (known.figure == name) f.unit = known.unit;
  return f;
}

}  // namespace

AcceptanceSheet::Kind verdict_of(const std::vector<Figure>& figures) {
  const auto any = [&](bool pass) {
    return std::any_of(figures.begin(), figures.end(), [&](const Figure& f) { return f.pass() == pass; });
  };
  if (any(false)) return AcceptanceSheet::Kind::fail;
  if (!any(true)) return AcceptanceSheet::Kind::not_judged;
  return unjudged_limits(figures).empty() ? AcceptanceSheet::Kind::pass : AcceptanceSheet::Kind::incomplete;
}

std::vector<std::string> unjudged_limits(const std::vector<Figure>& figures) {
  std::set<std::string> limited, judged;
  for (const Figure& f : figures)
    if (f.limit) (f.pass() ? judged : limited).insert(f.name);
  std::vector<std::string> out;
  std::set_difference(limited.begin(), limited.end(), judged.begin(), judged.end(), std::back_inserter(out));
  return out;
}

void judge(Sheet& sheet, const RigFile& rig, double guard) {
  for (Figure& f : sheet.figures) {
    const auto limit = rig.limits.find(f.name);
    if (limit == rig.limits.end()) continue;
    f.limit = limit->second;
    f.judgement = judged(f, limit->second, guard);
  }
  for (const auto& [name, limit] : rig.limits)
    if (std::none_of(sheet.figures.begin(), sheet.figures.end(),
                     [&name = name](const Figure& f) { return f.name == name; }))
      sheet.figures.push_back(not_shown(name, limit));
  sheet.verdict = verdict_of(sheet.figures);
  for (const std::string& name : unjudged_limits(sheet.figures))
    sheet.notes.push_back(
        {Note::Kind::unjudged_limit, "limit '" + name + "' is not judged: the log does not show the figure"});
}

}  // namespace servodx::curves
