// Measured against simulated, channel by channel, each with its residual and the band that fault-free logs leave: the
// part that shows why a verdict holds. All channels of a log zoom together; the one that the reference misses most
// comes first.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "report/shared/page.h"
#include "servodx/replay.h"

namespace servodx::report {

// Logs whose traces a page shows at most; of the rest it shows the figures.
inline constexpr std::size_t most_replays = 12;

struct ReplayView {
  std::vector<std::string> shown = {};  // names of explanations, the reference first; empty: all
  std::optional<double> onset = {};     // [s]
  std::size_t logs = 1;                 // that share the page: the more, the fewer samples of each are drawn
};

void add_replay(Page& page, const Replay& replay, const ReplayView& view);

std::string words(std::string label);  // "feedback_wire_lost" -> "feedback wire lost", "pressure_a" -> "pressure A"
std::string file_name(const std::string& path);  // without its folder

}  // namespace servodx::report
