// A run over a list, whatever it makes of a log: one log at a time, until a signal stops it.
#pragma once
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "fleet/gather.h"
#include "fleet/run.h"
#include "invocation.h"
#include "report/shared/json.h"
#include "servodx/error.h"
#include "servodx/rig.h"

namespace servodx {

// Why `work` on a log could not be done, be it refused or failed inside; nothing where it was done.
std::optional<InputError> refusal_of(const std::string& log, const std::function<void()>& work);

// Counts how one log ended, and says which was set aside.
void count(ListRun& run, RowEnd end, const std::optional<SetAside>& refusal, Progress& progress);

// Calls `row` for each of the run's logs, by its place. `label` is the command's name in the line of progress; `tell`
// shows that line anew.
using Tell = std::function<void()>;
void run_list(const std::string& label, ListRun& run, bool quiet,
              const std::function<void(std::size_t place, Progress& progress, const Tell& tell)>& row);

// A rehearsal reads every log and says which would be set aside.
void rehearse_list(const std::vector<std::string>& logs, const RigFile& rig, report::Header& header);

// For a run that a signal ended; none for others.
std::vector<std::string> interrupt_notice(const ListRun& run);

ExitCode code_of(const ListRun& run);

}  // namespace servodx
