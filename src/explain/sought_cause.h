// A cause as it is sought: what its numbers move in a candidate, and the sizes at which a score looks.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "effects/registry.h"
#include "explain/subject.h"
#include "fit/chart.h"
#include "servodx/table.h"
#include "simulate/scenario.h"

namespace servodx {

// A number of a cause. Its value starts where the model is the tuned one.
struct CauseNumber {
  FreeValue value;
  std::string unit;
  bool size = true;                    // false: shapes a cause that another number switches
  std::vector<double> sizes = {};      // [unit] at which a score looks
  std::optional<double> typical = {};  // [unit] of a shape that the table has otherwise; none: not tried
};
struct SoughtCause {
  Cause cause;
  std::vector<FreeValue> values;  // a number of the cause each
};

// An effect's j-th parameter about what the table has of it. What switches an effect may grow beyond.
FreeValue effect_value(const EffectInfo& effect, std::size_t j, const ParameterVector& tuned);
// A row over its range, which reaches as far as the tuned value at least.
FreeValue row_value(const Table& tuned, int at);

// Of the sizes asked for those in the value's range that differ from its start, each once.
std::vector<double> sizes_within(const FreeValue& value, const std::vector<double>& asked);
// A row has no typical size: some parts of its range away from where it is.
std::vector<double> sizes_of_row(const FreeValue& value);

// As a fit takes it.
Number number_of(const CauseNumber& number);
// Points at which a score looks: one alternative a size of one number, the rest as they are; all numbers together at
// their first sizes, where there are several; and each of these again with every shape at its typical value.
std::vector<std::vector<std::vector<double>>> probes_of(const std::vector<CauseNumber>& numbers);

// A cause by its name and place. `prior`: how common beside the others, before any data.
Cause named(std::string effect, std::string where, double prior = 1.0);
// The cause with these numbers; without probes where no size of any is left to look at.
SoughtCause sought(Cause cause, const std::vector<CauseNumber>& numbers);

}  // namespace servodx
