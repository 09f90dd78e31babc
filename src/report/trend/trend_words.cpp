#include "report/trend/trend_words.h"

namespace servodx::report {

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
