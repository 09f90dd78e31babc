#include "explain/share_null.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "evidence/excess_trend.h"
#include "evidence/tail_law.h"
#include "explain/constants.h"
#include "explain/usual_excess.h"

namespace servodx {
namespace {

namespace k = explain_constants;

// Misfits are ratios: what removes nine tenths and then nine tenths of the rest is twice as much. [-]
double excess_of(double share) { return -std::log(std::max(k::all_but, 1 - std::max(0.0, share))); }

// None where the suspects' oil is not known.
ExcessTrend trend_of(const std::vector<SharesOfLog>& healthy, double thickness) {
  std::vector<ExcessAt> best;
  for (const SharesOfLog& log : healthy) {
    ExcessAt& of = best.emplace_back(0.0, log.thickness);
    for (const auto& [effect, share] : log.of_effect) of.excess = std::max(of.excess, excess_of(share));
  }
  return ExcessTrend(std::isfinite(thickness) ? best : std::vector<ExcessAt>());
}

std::vector<Excesses> excesses_of(const std::vector<SharesOfLog>& healthy, const ExcessTrend& trend) {
  std::vector<Excesses> out;
  for (const SharesOfLog& log : healthy) {
    Excesses& of = out.emplace_back();
    for (const auto& [effect, share] : log.of_effect) of[effect] = excess_of(share) / trend.scale(log.thickness);
  }
  return out;
}

std::vector<double> largest_ratios(const std::vector<Excesses>& healthy, const UsualExcesses& usual) {
  std::vector<double> out;
  for (const Excesses& log : healthy) out.push_back(usual.largest_ratio(log));
  return out;
}

}  // namespace

UsualExcesses::UsualExcesses(const std::vector<Excesses>& healthy)
    : logs_(k::usual_logs + static_cast<double>(healthy.size())) {
  for (const Excesses& log : healthy)
    for (const auto& [effect, excess] : log) sum_[effect] += excess;
}

double UsualExcesses::of(const std::string& effect) const {
  const auto it = sum_.find(effect);
  return (usual_excess(effect) * k::usual_logs + (it == sum_.end() ? 0.0 : it->second)) / logs_;
}

double UsualExcesses::largest_ratio(const Excesses& one) const {
  double out = 0;
  for (const auto& [effect, excess] : one) {
    const double others = (of(effect) * logs_ - excess) / (logs_ - 1);
    out = std::max(out, excess / others);
  }
  return out;
}

ShareNull::ShareNull(const std::vector<SharesOfLog>& healthy, double thickness)
    : ShareNull(healthy, thickness, trend_of(healthy, thickness)) {}

ShareNull::ShareNull(const std::vector<SharesOfLog>& healthy, double thickness, const ExcessTrend& trend)
    : ShareNull(excesses_of(healthy, trend), trend.scale(thickness)) {}

ShareNull::ShareNull(const std::vector<Excesses>& healthy, double scale)
    : scale_(scale), usual_(healthy), law_(largest_ratios(healthy, usual_), {k::usual_ratio, k::usual_logs}) {}

double ShareNull::ratio(const std::string& effect, double share) const {
  return excess_of(share) / scale_ / usual_.of(effect);
}

int ShareNull::logs_needed(const std::string& effect, double share, double asked) const {
  return law_.logs_needed(ratio(effect, share), asked, k::of_shares);
}

}  // namespace servodx
