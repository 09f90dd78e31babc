#include "diagnose/moved.h"

#include <algorithm>
#include <cmath>

#include "diagnose/constants.h"
#include "effects/registry.h"
#include "fit/chart.h"
#include "fit/identifiability.h"
#include "optimise/unit_cube.h"
#include "parameters/list.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

struct RowName {
  int id = 0;
  std::string name, unit;
};

std::optional<RowName> name_of(const Table& tuned, int position) {
  if (position < n_parameters) return RowName{tuned[position].id, tuned[position].name, tuned[position].unit};
  for (const EffectInfo& e : effect_list())
    if (const int j = position - e.first; j >= 0 && j < static_cast<int>(e.parameters.size()))
      return RowName{0, e.parameters[static_cast<std::size_t>(j)].name, e.parameters[static_cast<std::size_t>(j)].unit};
  return std::nullopt;
}

}  // namespace

std::vector<MovedRow> moved_rows(const HypothesisFit& fit, const ParameterVector& base, const Table& tuned) {
  if (!fit.ok) return {};
  const Chart chart(base, fit.free);
  const ParameterVector best = chart.candidate(fit.point, 0);
  // Which free values move a position, and by how much within one error.
  std::vector<double> variance(best.size(), 0.0);
  std::vector<char> on_bound(best.size(), 0);
  std::vector<MovedRow::By> by(best.size(), MovedRow::By::nuisance);
  for (std::size_t j = 0; j < fit.free.size(); ++j) {
    const bool fault = fit.fault && j == 0;
    Point low = fit.point, high = fit.point;
    double deviates = 1.0;
    if (fault) {
      low[j] = fit.free[j].to_unit(fit.severity_lower), high[j] = fit.free[j].to_unit(fit.severity_upper);
      deviates = diagnose_constants::deviates_of_95;
    } else {
      low[j] = std::max(0.0, fit.point[j] - fit.standard_error[j]);
      high[j] = std::min(1.0, fit.point[j] + fit.standard_error[j]);
    }
    Point far = fit.point;  // whose rows these are does not hang on an error
    far[j] = fit.point[j] > 0.5 ? 0.0 : 1.0;
    const ParameterVector from = chart.candidate(low, 0), to = chart.candidate(high, 0), away = chart.candidate(far, 0);
    for (std::size_t i = 0; i < best.size(); ++i) {
      if (away[i] == best[i]) continue;
      const double half = 0.5 * (to[i] - from[i]) / deviates;
      variance[i] += half * half;
      if (half == 0) on_bound[i] = 1;
      if (fault)
        by[i] = MovedRow::By::fault;
      else if (fit.free[j].apply && by[i] != MovedRow::By::fault)
        by[i] = MovedRow::By::tolerance;
    }
  }
  std::vector<MovedRow> rows;
  for (std::size_t i = 0; i < best.size(); ++i) {
    const auto row = best[i] == base[i] ? std::nullopt : name_of(tuned, static_cast<int>(i));
    if (!row) continue;
    MovedRow m;
    m.id = row->id, m.name = row->name, m.unit = row->unit;
    m.nominal = base[i], m.estimate = best[i];
    m.std_error = on_bound[i] ? std::nan("") : std::sqrt(variance[i]);
    m.verdict = on_bound[i] ? RowVerdict::at_bound : RowVerdict::bounded;
    m.by = by[i];
    rows.push_back(std::move(m));
  }
  std::stable_sort(rows.begin(), rows.end(), [](const MovedRow& a, const MovedRow& b) { return a.by < b.by; });
  return rows;
}

}  // namespace servodx
