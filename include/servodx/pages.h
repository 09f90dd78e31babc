// What the program's pages draw beside a result: logs beside what it says they should have been, frequency responses.
//
// A replay costs one simulation an explanation. Residuals are filtered as a fit's are; sigma is the sensor's noise and
// what the model is known to err by. `most`: replays at most; a page of many would be too large to open.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "servodx/baseline.h"
#include "servodx/bode.h"
#include "servodx/diagnose.h"
#include "servodx/explain.h"
#include "servodx/log.h"
#include "servodx/replay.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "servodx/tune.h"

namespace servodx {

// Of the table as it is, its effects at their own values and no offset fitted. `name`: of the explanation.
Replay replay_of(const Log& log, const Table& table, const Rig& rig, const std::string& name);

// `logs`: those that the result was made of, in its order. Of a tune, what it says of each log; a table that was read
// says nothing of its logs, and has none.
std::vector<Replay> replays_of(const Tuned& tuned, const std::vector<Log>& logs, const Rig& rig, std::size_t most);
// The tuned model with what was fitted to each healthy log; none of a baseline that was read.
std::vector<Replay> replays_of(const Baseline& baseline, const std::vector<Log>& logs, const Tuned& tuned,
                               const Rig& rig, std::size_t most);
// As tuned and, where a cause was found, with it.
std::vector<Replay> replays_of(const Explanation& explanation, const std::vector<Log>& logs, const Tuned& tuned,
                               const Rig& rig, std::size_t most);
// Health and each fault that could be fitted, of the logs farthest from health; of a pool its first log.
std::vector<Replay> replays_of(const std::vector<Verdict>& verdicts, const std::vector<Log>& logs, const Tuned& tuned,
                               const Rig& rig, std::size_t most);

// Of a verdict that holds a valve: as tuned, and as the log has it, each at two amplitudes. An unknown state has none.
std::vector<Bode> bodes_of(const Verdict& verdict, const Tuned& tuned, const Rig& rig);

// The picture that a rig file names for the head of its pages, as a data URI; empty where none is named. Throws
// InputError where it is no picture.
std::string logo_of(const Rig& rig);

// The label in LOG.truth.json beside a log of the virtual rig, where it speaks of this log's bytes; else empty.
std::string truth_beside(const Log& log);

}  // namespace servodx
