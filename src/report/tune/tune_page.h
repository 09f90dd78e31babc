// The page of `tune`.
#pragma once
#include <vector>

#include "report/shared/json.h"
#include "report/shared/page.h"
#include "report/tune/tune_words.h"
#include "servodx/replay.h"
#include "tune/tune.h"

namespace servodx::report {

// `replays`: of some of the result's logs, by path; what is not there is not drawn.
Page tune_page(const Header& header, const TuneResult& result, const GoodEnough& good,
               const std::vector<Replay>& replays);

}  // namespace servodx::report
