// Logs of one valve in one state made ready to be fitted: a fast one at points, each without the channels of which the
// table does not say how wrong its model is.
#pragma once
#include <cstddef>
#include <vector>

#include "fit/error_model.h"
#include "fit/log_data.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "signals/log.h"

namespace servodx {

struct ReadyLogs {
  std::vector<LogData> data;
  std::vector<LogData> recorded;  // the same sample by sample, where a fast log is fitted at points; else empty
  std::vector<Note> notes;        // of the readers, of what was resampled and of what was left out
  const LogData& every_sample(std::size_t log) const { return recorded[log].path.empty() ? data[log] : recorded[log]; }
  std::vector<const LogData*> pointers() const;
};

// In their order. Throws InputError where a log has no channel to compare. `error`: of the table.
ReadyLogs make_ready(const std::vector<Log>& logs, const Table& tuned, const RigFile& rig, const ErrorModel& error);

}  // namespace servodx
