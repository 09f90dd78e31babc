// The page of `baseline`.
#pragma once
#include <vector>

#include "diagnose/baseline.h"
#include "report/shared/json.h"
#include "report/shared/page.h"
#include "servodx/baseline.h"
#include "servodx/replay.h"

namespace servodx::report {

// `replays`: of some of the result's logs, by path; what is not there is not drawn.
Page baseline_page(const Header& header, const DetectionBaseline& baseline, const std::vector<Replay>& replays);
Page baseline_page(const Header& header, const Baseline& baseline, const std::vector<Replay>& replays);

}  // namespace servodx::report
