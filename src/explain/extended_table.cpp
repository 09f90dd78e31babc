#include "explain/extended_table.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "effects/effect.h"
#include "effects/registry.h"
#include "effects/unexplained.h"
#include "fit/chart.h"
#include "fit/free_values.h"
#include "parameters/list.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

void write_retuned_rows(const ParameterVector& fitted, bool several_logs, Table& table) {
  for (int i = 0; i < n_parameters; ++i) {
    Row& row = table[i];
    if (row.nominal == fitted[static_cast<std::size_t>(i)]) continue;
    const bool of_each_log = i == row::servovalve_null || i == row::air_fraction;
    if (of_each_log && several_logs) continue;
    row.nominal = std::clamp(fitted[static_cast<std::size_t>(i)], row.lower, row.upper);
    row.source = "explain: re-tuned; before: " + row.source;
  }
}

// Position of a value's row, made where the table has none; negative where no effect has a row of that name.
int row_of(const FreeValue& value, const std::string& unit, Table& table) {
  if (const int at = table.find(value.name); at >= 0) return at;
  for (const EffectInfo& effect : effect_list())
    for (const EffectParameter& p : effect.parameters) {
      if (value.name != p.name) continue;
      Row row;
      row.name = value.name;
      row.group = "effect:" + effect.name;
      row.lower = value.lower, row.upper = value.upper;
      row.estimate = true;
      row.unit = unit;
      row.description = p.meaning;
      table.rows.push_back(std::move(row));
      return static_cast<int>(table.rows.size()) - 1;
    }
  return -1;
}

// A cause's values with what is known of each; of a curve its codes and scale as well, which are rows too.
struct CauseRows {
  std::vector<FreeValue> values;
  std::vector<ExplainedParameter> parameters;
};
CauseRows rows_of_cause(const ValveSubject& subject, int cause, const ExplainedCause& about,
                        const ParameterVector& fitted) {
  CauseRows out{subject.values(cause), about.parameters};
  if (!subject.causes()[static_cast<std::size_t>(cause)].curve) return out;
  for (int j = 0; j < Unexplained::n_parameters - Unexplained::knots; ++j) {
    const EffectParameter& p = Unexplained::parameters[j];
    FreeValue code;
    code.name = p.name, code.lower = p.lower, code.upper = p.upper;
    out.values.push_back(code);
    const double value = fitted[static_cast<std::size_t>(effect_row<Unexplained>(j))];
    out.parameters.push_back({p.name, p.unit, value, std::nan(""), 0});
  }
  return out;
}

void write_cause(const CauseRows& rows, const std::string& effect, Table& table) {
  for (std::size_t j = 0; j < rows.values.size(); ++j) {
    if (rows.values[j].log > 0) continue;
    const ExplainedParameter& p = rows.parameters[j];
    const int at = row_of(rows.values[j], p.unit, table);
    if (at < 0) continue;
    Row& row = table[at];
    row.nominal = std::clamp(p.value, row.lower, row.upper);
    if (std::isfinite(p.std_error)) row.std_error = p.std_error;
    row.source = "explain: " + effect;
  }
}

}  // namespace

Table extended_table(const ValveSubject& subject, const FoundCauses& found, const std::vector<ExplainedCause>& causes) {
  Table table = subject.table();
  if (found.causes.empty()) return table;
  const ParameterVector fitted = subject.candidate(found.after.causes, found.after.point, 0);
  write_retuned_rows(fitted, subject.logs().size() > 1, table);
  for (std::size_t k = 0; k < causes.size(); ++k)
    write_cause(rows_of_cause(subject, found.causes[k].cause, causes[k], fitted), causes[k].effect, table);
  return table;
}

}  // namespace servodx
