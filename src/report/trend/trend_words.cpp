#include "report/trend/trend_words.h"

#include <cmath>

#include "report/shared/handy.h"

namespace servodx::report {

std::string in_hours(double hours) { return std::isfinite(hours) ? digits(hours) + " h" : "never"; }

const char* word_of(TrendState state) {
  switch (state) {
    case TrendState::unknown:
      return "unknown";
    case TrendState::blind:
      return "blind";
    case TrendState::healthy:
      return "healthy";
    case TrendState::watch:
      return "watch";
    case TrendState::warning:
      return "warning";
    case TrendState::failed:
      return "failed";
  }
  return "";
}

}  // namespace servodx::report
