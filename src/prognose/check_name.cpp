#include "prognose/check_name.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <string_view>
#include <system_error>
#include <utility>

#include "parameters/list.h"
#include "prognose/constants.h"

namespace servodx {

using namespace prognose_constants;

namespace {

constexpr std::string_view mean_error_text = "mean_error", fidelity_text = "fidelity";
constexpr std::string_view correlation_start = "correlation@", parameter_start = "parameter:";

std::optional<int> row_called(const std::string& text) {
  const std::string_view id = std::string_view(text).substr(parameter_start.size());
  int number = 0;
  const auto [end, error] = std::from_chars(id.data(), id.data() + id.size(), number);
  if (error != std::errc() || end != id.data() + id.size() || id.front() == '0') return {};
  return number >= 1 && number <= n_parameters ? std::optional(number - 1) : std::nullopt;
}

}  // namespace

CheckName::CheckName(std::string text) : text_(std::move(text)) {
  if (text_ == mean_error_text) kind_ = CheckKind::mean_error;
  if (text_ == fidelity_text) kind_ = CheckKind::fidelity;
  if (text_.starts_with(correlation_start)) kind_ = CheckKind::correlation;
  if (text_.starts_with(parameter_start)) kind_ = CheckKind::parameter, row_ = row_called(text_);
}

CheckName CheckName::of_mean_error() { return std::string(mean_error_text); }
CheckName CheckName::of_fidelity() { return std::string(fidelity_text); }
CheckName CheckName::of_correlation(double frequency) {
  return fmt::format("{}{:.4g}Hz", correlation_start, std::round(frequency * frequency_steps) / frequency_steps);
}
CheckName CheckName::of_row(int row) { return fmt::format("{}{}", parameter_start, row + 1); }

std::string CheckName::detail() const {
  if (kind_ == CheckKind::correlation) return text_.substr(correlation_start.size());
  if (kind_ == CheckKind::parameter) return text_.substr(parameter_start.size());
  return {};
}

}  // namespace servodx
