#include "report/shared/parameter_part.h"

#include <algorithm>
#include <cmath>

#include "fit/identifiability.h"
#include "fit/row_meaning.h"
#include "report/shared/columns.h"
#include "report/shared/handy.h"
#include "report/shared/replay_part.h"
#include "servodx/table.h"
#include "servodx/tune.h"

namespace servodx::report {
namespace {

std::string verdict_in_words(const ParameterResult& p) {
  std::vector<std::string> others;
  for (const std::string& name : p.confounded_with)
    if (std::find(others.begin(), others.end(), name) == others.end()) others.push_back(name);
  if (p.verdict == RowVerdict::flat) return "the logs do not show it";
  if (p.verdict == RowVerdict::confounded) return "held: the logs show it only together with " + words(join(others));
  if (p.verdict == RowVerdict::at_bound) return "at the end of its range";
  if (p.verdict == RowVerdict::one_sided) return "known on one side only";
  if (p.verdict == RowVerdict::frozen) return "held";
  return "";
}

}  // namespace

Moves moves_of(const std::vector<ParameterResult>& parameters, const std::string& title) {
  Moves moves{title, {}, 0};
  for (const ParameterResult& p : parameters) {
    const HandyUnit unit = handy_unit(p.unit, std::max(std::abs(p.nominal), std::abs(p.estimate)));
    Moves::Row row;
    row.name = words(p.name);
    row.from = digits(p.nominal * unit.factor, 4);
    row.to = digits(p.estimate * unit.factor, 4);
    row.error = std::isfinite(p.std_error) ? digits(p.std_error * unit.factor, 2) : "";
    row.unit = unit.name;
    if (std::isfinite(p.std_error) && p.std_error > 0) row.sigmas = (p.estimate - p.nominal) / p.std_error;
    row.note = meaning_of_row(p.name);
    if (const std::string verdict = verdict_in_words(p); !verdict.empty())
      row.note += (row.note.empty() ? "" : "; ") + verdict;
    row.exact_from = p.nominal, row.exact_to = p.estimate, row.exact_error = p.std_error;
    row.exact_unit = p.unit == "-" ? "" : p.unit;
    moves.rows.push_back(std::move(row));
  }
  const auto far = [](const Moves::Row& r) {
    const double size = std::max(std::abs(r.exact_from), std::abs(r.exact_to));
    const double share = size > 0 ? std::abs(r.exact_to - r.exact_from) / size : 0;
    return std::pair(std::isfinite(r.sigmas) ? std::abs(r.sigmas) : 0.0, share);
  };
  std::stable_sort(moves.rows.begin(), moves.rows.end(), [&](const auto& a, const auto& b) { return far(a) > far(b); });
  return moves;
}

}  // namespace servodx::report
