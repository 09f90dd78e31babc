// How a channel or block errs on the middle one of the healthy logs.
#pragma once
#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "explain/constants.h"
#include "explain/valve.h"

namespace servodx {

struct MiddleError {
  double size = 0;       // rms, in the unit of its UsualError
  double effective = 1;  // fraction of the samples that counts as independent
};
// Empty where fewer than three healthy logs show it.
inline std::optional<MiddleError> middle_error(const std::vector<UsualError>& all, const std::string& signal) {
  std::vector<std::pair<double, double>> usual;
  for (const UsualError& e : all)
    if (e.signal == signal) usual.emplace_back(e.size, e.effective);
  if (usual.size() < explain_constants::fewest_usual) return {};
  const auto middle = usual.begin() + static_cast<long>(usual.size() / 2);
  std::nth_element(usual.begin(), middle, usual.end());
  return MiddleError{middle->first, middle->second};
}

}  // namespace servodx
