// Logs from memory: a column's name carries its unit as a header cell does, and the rules are those of files.
#include <span>

#include "servodx/log.h"
#include "servodx/rig.h"
#include "signals/log_columns.h"

namespace servodx {

Log make_log(const std::string& name, const std::vector<LogColumn>& columns, const RigFile& rig,
             const ReadOptions& options) {
  options.validate();
  LogColumns log(name, rig, options, {.has_units = true, .has_lines = false});
  std::vector<std::span<const double>> values;
  for (const LogColumn& column : columns)
    if (log.add(column.name, 0) >= 0) values.emplace_back(column.values);
  log.require_signals();
  log.append_columns(values);
  return log.finish({});
}

}  // namespace servodx
