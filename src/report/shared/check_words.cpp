#include "report/shared/check_words.h"

#include "report/shared/replay_part.h"

namespace servodx::report {

std::string name_of_check(const CheckName& check, const std::string& cause) {
  if (!cause.empty()) {
    const bool row = check.kind() == CheckKind::parameter && !check.detail().empty();
    return words(cause) + " (" + (row ? "row " + check.detail() : check.text()) + ")";
  }
  switch (check.kind()) {
    case CheckKind::mean_error:
      return "mean error |e|";
    case CheckKind::fidelity:
      return "fidelity r";
    case CheckKind::correlation:
      return check.detail().empty() ? check.text() : "correlation E(tau) at " + check.detail();
    default:
      return check.text();
  }
}

HandyUnit unit_of_check(const std::string& unit, const std::string& cause, double magnitude) {
  return unit == "-" && !cause.empty() ? HandyUnit{"%", 100.0} : handy_unit(unit, magnitude);
}

std::string size_of_check(const std::string& unit, const std::string& cause, double value) {
  const HandyUnit in = unit_of_check(unit, cause, value);
  return digits(value * in.factor) + (in.name.empty() ? "" : " " + in.name);
}

}  // namespace servodx::report
