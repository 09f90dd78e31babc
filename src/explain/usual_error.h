// How a channel or block errs on the middle one of the healthy logs, and weights by that.
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "explain/constants.h"
#include "explain/subject.h"
#include "explain/valve.h"
#include "fit/error_model.h"

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

// Root of the mean square. [of x]
inline double rms_of_rows(const Eigen::VectorXd& x) {
  return std::sqrt(x.squaredNorm() / static_cast<double>(x.size()));
}

// Weighs a series by what is left of it, `own`, or by what is usual of it where that is less, never below `least`.
// [its unit]
inline void weigh_by_usual(const Eigen::VectorXd& own, const std::vector<UsualError>& all, double least, Series& s,
                           std::vector<double>& sigma) {
  double size = rms_of_rows(own);
  s.effective = effective_fraction({own.data(), own.data() + own.size()});
  if (const std::optional<MiddleError> usual = middle_error(all, s.signal); usual && usual->size < size)
    size = usual->size, s.effective = usual->effective;
  std::fill(sigma.begin(), sigma.end(), std::max(least, size) / std::sqrt(s.effective));
}

}  // namespace servodx
