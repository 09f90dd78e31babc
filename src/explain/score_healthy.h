// The scoring of healthy logs, each as a suspect will be: weighed by what the other logs say is usual.
#pragma once
#include <cstddef>
#include <functional>
#include <vector>

#include "base/stages.h"
#include "explain/healthy.h"
#include "parameters/table.h"
#include "servodx/rig.h"
#include "signals/log.h"

namespace servodx {

struct HealthyCounts {
  long simulations = 0, failed = 0;
};
// `told`: fraction done; false from it ends the work, and the logs that are done are returned. `others`: of other
// tests, or those that tuned the table; they are scored, as such, where `logs` are of too few tests to show how sizes
// scatter from test to test. `stages`: of this table and rig.
HealthyReference score_healthy(const std::vector<Log>& logs, const Table& tuned, const RigFile& rig, int threads,
                               HealthyCounts& counts, const std::function<bool(double)>& told = {},
                               const std::vector<Log>& others = {}, const Stages& stages = {});
// How many of them it scores.
std::size_t logs_to_score(const std::vector<Log>& logs, const std::vector<Log>& others);

}  // namespace servodx
