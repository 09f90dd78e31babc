// The residual of each channel in its own unit, as tuned and with what was found, as fitted and held out.
#pragma once
#include <vector>

#include "explain/engine.h"
#include "explain/explain.h"
#include "explain/subject.h"
#include "servodx/log.h"

namespace servodx {

std::vector<ExplainedChannel> explained_channels(const Subject& subject, const std::vector<Log>& logs,
                                                 const FoundCauses& found);

}  // namespace servodx
