// How the hypotheses about a valve's logs are fitted: options, rig file and table made into settings.
#pragma once
#include <vector>

#include "diagnose/hypotheses.h"
#include "servodx/diagnose.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "signals/log.h"

namespace servodx {

// Without progress, which each caller of the fits tells for itself. `options` are valid.
HypothesisSettings hypothesis_settings(const std::vector<Log>& logs, const Table& tuned, const RigFile& rig,
                                       const DiagnoseOptions& options);

}  // namespace servodx
