// The page of `simulate`.
#pragma once
#include "report/shared/json.h"
#include "report/shared/page.h"
#include "servodx/replay.h"

namespace servodx::report {

Page simulate_page(const Header& header, const Replay& replay);

}  // namespace servodx::report
