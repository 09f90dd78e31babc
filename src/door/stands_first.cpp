#include "door/stands_first.h"

#include "explain/outcome.h"

namespace servodx {

BeyondFaults stands_first(const ExplainResult& r) {
  if (!r.causes.empty()) {
    const ExplainedCause& c = r.causes.front();
    return {c.effect,
            c.where,
            c.curve ? r.depends_on : "",
            c.heldout_gain.value,
            true,
            c.of_sensor || c.told_by == ToldBy::currents};
  }
  if (r.suspicion)
    return {r.suspicion->effect, r.suspicion->where, "", r.suspicion->share.value, false, r.suspicion->of_sensor};
  return {"", r.where, r.depends_on, 0.0, false};
}

}  // namespace servodx
