#include "explain/healthy.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace servodx {

std::string place_key(const Cause& cause) { return cause.where + (cause.family.empty() ? "" : "/" + cause.family); }

int HealthyReference::promising() const {
  return static_cast<int>(std::count_if(logs.begin(), logs.end(), [](const HealthyLog& l) { return !l.other; }));
}

KnownRig HealthyReference::known(int left_out) const {
  KnownRig out;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    const HealthyLog& l = logs[i];
    if (static_cast<int>(i) == left_out) continue;
    out.errors.insert(out.errors.end(), l.errors.begin(), l.errors.end());
    if (l.air > 0) out.air.push_back(l.air);
    if (std::isfinite(l.command_slope)) out.command_slope.push_back(l.command_slope);
    if (std::isfinite(l.drive_delay)) out.drive_delay.push_back(l.drive_delay);
  }
  return out;
}

HealthyReference of_causes(const HealthyReference& reference, const Subject& subject) {
  const auto is_one = [&](const HealthyScore& s) {
    return std::any_of(subject.causes().begin(), subject.causes().end(),
                       [&](const Cause& c) { return c.effect == s.effect && place_key(c) == s.where; });
  };
  HealthyReference out = reference;
  for (HealthyLog& log : out.logs) std::erase_if(log.scores, [&](const HealthyScore& s) { return !is_one(s); });
  return out;
}

}  // namespace servodx
