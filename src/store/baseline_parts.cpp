#include "store/baseline_parts.h"

namespace servodx {

const BaselineParts& parts_of(const Baseline& baseline) {
  if (!baseline.parts) throw InputError({}, "the baseline is empty", "make one, or read one from its file");
  return *baseline.parts;
}

const HealthyReference& causes_of(const Baseline& baseline) {
  const BaselineParts& parts = parts_of(baseline);
  if (!parts.causes) throw InputError(*parts.causes_refused);
  return *parts.causes;
}

}  // namespace servodx
