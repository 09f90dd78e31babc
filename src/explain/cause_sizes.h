// What one log says of each cause: the size that it shows at each probe, with a standard error. Healthy logs and
// suspects are asked alike, of the simulation, of the blocks' replay and of the driver.
#pragma once
#include <string>
#include <vector>

#include "explain/blocks.h"
#include "explain/cause_score.h"
#include "explain/healthy.h"
#include "explain/subject.h"
#include "explain/valve.h"
#include "optimise/unit_cube.h"
#include "signals/log.h"

namespace servodx {

HealthyScore summarise(const Subject& subject, const CauseScore& score);
// The same of the blocks' replay of a valve's logs; `at`: a point of valve.fit({}). Empty: no log shows the blocks.
struct ScoredBlocks {
  std::vector<HealthyScore> scores;
  std::vector<Miss> misses;
};
ScoredBlocks score_blocks(const ValveSubject& valve, const Point& at, const KnownRig& known);
// What the driver shows of each cause; empty where the log has not both command and coil current.
std::vector<HealthyScore> score_drive(const Log& log, const KnownRig& known);

}  // namespace servodx
