// How far off the log is lately: squared deviates of each channel, averaged over times from short to long.
#pragma once
#include <array>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "online/constants.h"
#include "online/residuals.h"

namespace servodx {

using Levels = std::array<double, online_constants::n_windows>;  // [deviates^2] of each window

class SlidingEvidence {
 public:
  explicit SlidingEvidence(std::size_t channels) : levels_(channels), quiet_(channels, -1e300) { restart(); }
  // `limits` of each channel say what is quiet; without them, what is quiet for a model without error.
  void take(const Residual& residual, const std::vector<Levels>& limits = {});
  void restart();
  const std::vector<Levels>& levels() const { return levels_; }
  // [s] when the channel's shortest window was last as quiet as a healthy valve's.
  double quiet_until(std::size_t channel) const { return quiet_[channel]; }

  nlohmann::json state() const;
  void resume(const nlohmann::json& state);

 private:
  std::vector<Levels> levels_;
  std::vector<double> quiet_;
  double last_ = -1e300;
};

}  // namespace servodx
