// The paper's rule of the life left (Borello et al. 2009, sec. 9), beside ours.
#pragma once
#include <optional>
#include <vector>

namespace servodx {

struct TangentRule {
  double alert_at = 0;         // [h]
  double time_to_failure = 0;  // [h] from the alert
};

// A quadratic by least squares through what lies beyond the threshold; alert where it passes the warning level; time to
// failure = (failure - warning) / slope of the tangent there. Rising figures; mirror others.
std::optional<TangentRule> tangent_rule(const std::vector<double>& time, const std::vector<double>& value,
                                        double threshold, double warning, double failure);

}  // namespace servodx
