#include "diagnose/blame.h"

#include "diagnose/broken_sensors.h"
#include "diagnose/decide.h"
#include "diagnose/judge.h"
#include "diagnose/judgeable.h"
#include "faults/fault.h"

namespace servodx {
namespace {

bool is_of_columns(Unjudgeable why) {
  switch (why) {
    case Unjudgeable::command_missing:
    case Unjudgeable::command_too_large:
    case Unjudgeable::pressure_beyond_supply:
    case Unjudgeable::position_beyond_travel:
    case Unjudgeable::pressures_out_of_order:
    case Unjudgeable::rows_jump:
    case Unjudgeable::copied:
    case Unjudgeable::oil_beyond:
      return true;
    case Unjudgeable::no:
    case Unjudgeable::nothing_asked:
    case Unjudgeable::sensors_still:
    case Unjudgeable::noise_alone:
    case Unjudgeable::too_short:
    case Unjudgeable::coarse:
      return false;
  }
  return false;
}

Blame blame_of_fault(const Diagnosis& d) {
  if (const auto finding = sensor_finding_of(d);
      finding == SensorFinding::turned || finding == SensorFinding::swapped_ports)
    return Blame::log;
  return d.fault && d.fault->told_by ? Blame::surroundings : Blame::component;
}

Blame blame_of_unknown(const Diagnosis& d) {
  if (d.doubt == Doubt::misread || is_of_columns(d.assessment.unjudgeable)) return Blame::log;
  if (!d.beyond || !d.beyond->taken) return Blame::test;
  return d.beyond->outside ? Blame::surroundings : Blame::physics;
}

}  // namespace

std::optional<SensorFinding> sensor_finding_of(const Diagnosis& d) {
  if (d.faults.empty() || !d.faults.front().record) return {};
  return d.faults.front().record->broken;
}

Blame blame_of(const Diagnosis& d) {
  switch (d.verdict) {
    case VerdictKind::healthy:
      return Blame::none;
    case VerdictKind::fault:
      return blame_of_fault(d);
    case VerdictKind::unknown:
      return blame_of_unknown(d);
  }
  return Blame::none;
}

}  // namespace servodx
