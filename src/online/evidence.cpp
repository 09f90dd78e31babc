#include "online/evidence.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>

#include "fit/log_gaps.h"

namespace servodx {

namespace k = online_constants;

void SlidingEvidence::restart() {
  for (Levels& l : levels_) l.fill(1.0);
}

void SlidingEvidence::take(const Residual& residual, const std::vector<Levels>& limits) {
  const double dt = residual.time - last_;
  last_ = residual.time;
  if (!residual.comparable || !(dt > 0)) return;
  for (std::size_t c = 0; c < levels_.size(); ++c) {
    if (std::isnan(residual.value[c])) continue;
    const double square = std::min(residual.value[c] * residual.value[c], k::largest_square);
    for (std::size_t w = 0; w < levels_[c].size(); ++w)
      levels_[c][w] += (1 - std::exp(-std::min(dt, gap_memory) / k::windows[w])) * (square - levels_[c][w]);
    const double quiet = limits.empty() ? k::quiet_square : std::max(k::quiet_square, k::quiet_part * limits[c][0]);
    if (levels_[c][0] < quiet) quiet_[c] = residual.time;
  }
}

nlohmann::json SlidingEvidence::state() const { return {{"levels", levels_}, {"quiet", quiet_}, {"last", last_}}; }

void SlidingEvidence::resume(const nlohmann::json& state) {
  const auto levels = state.at("levels").get<std::vector<Levels>>();
  const auto quiet = state.at("quiet").get<std::vector<double>>();
  if (levels.size() != levels_.size() || quiet.size() != quiet_.size()) return;
  levels_ = levels, quiet_ = quiet, last_ = state.at("last");
}

}  // namespace servodx
