#include "diagnose/ready_logs.h"

#include <utility>

#include "fit/fast_log.h"
#include "fit/tuned_state.h"
#include "servodx/log.h"

namespace servodx {

std::vector<const LogData*> ReadyLogs::pointers() const {
  std::vector<const LogData*> out;
  for (const LogData& d : data) out.push_back(&d);
  return out;
}

ReadyLogs make_ready(const std::vector<Log>& logs, const Table& tuned, const RigFile& rig, const ErrorModel& error) {
  ReadyLogs ready;
  for (const Log& log : logs) {
    ready.notes.insert(ready.notes.end(), log.notes.begin(), log.notes.end());
    const bool fast = is_fast(log);
    ready.recorded.push_back(fast ? prepare(log, rig, recorder_of(tuned)) : LogData{});
    ready.data.push_back(fast ? at_points(ready.recorded.back()) : prepare(log, rig, recorder_of(tuned)));
    for (const Note& note : ready.data.back().notes)
      if (note.kind == Note::Kind::resampled) ready.notes.push_back(note);
    leave_out_unknown_channels(ready.recorded.back(), error);
    for (Note& note : leave_out_unknown_channels(ready.data.back(), error)) ready.notes.push_back(std::move(note));
    require_channels(ready.data.back());
  }
  return ready;
}

}  // namespace servodx
