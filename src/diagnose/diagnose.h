// `baseline` and `diagnose`: is this log like the fault-free ones, and if not, which fault, how large, since when.
//
//   assess     a gross look, every hypothesis fitted, an onset looked for, the hypotheses weighed
//   judge      the assessment beside a baseline: verdict, fault, size
//   diagnose   both
#pragma once
#include <vector>

#include "diagnose/assessment.h"
#include "diagnose/baseline.h"
#include "diagnose/judge.h"
#include "parameters/table.h"
#include "servodx/diagnose.h"
#include "servodx/rig.h"
#include "signals/log.h"

namespace servodx {

// Stopped by options.watch, it returns at once with an assessment to be thrown away.
Assessment assess(const Log& log, const Table& tuned, const RigFile& rig, const DiagnoseOptions& options);
// Several logs of one valve in one state as one; an onset is not looked for. At least one log.
Assessment assess_pool(const std::vector<Log>& logs, const Table& tuned, const RigFile& rig,
                       const DiagnoseOptions& options);

Diagnosis diagnose(const Log& log, const Table& tuned, const RigFile& rig, const DetectionBaseline& baseline,
                   const DiagnoseOptions& options);

// Refuses logs that tuned the table (by hash), the same log twice, fewer than three logs. Throws InputError.
void require_logs_for_baseline(const std::vector<Log>& logs, const std::vector<Log>& others, const Table& tuned);
// After that. `others`: of other tests, or those that tuned.
DetectionBaseline make_baseline(const std::vector<Log>& logs, const Table& tuned, const RigFile& rig,
                                double false_alarm, const DiagnoseOptions& options, long* simulations = nullptr,
                                long* failed = nullptr, const std::vector<Log>& others = {});

}  // namespace servodx
