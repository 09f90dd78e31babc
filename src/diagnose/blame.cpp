#include "diagnose/blame.h"

#include "diagnose/decide.h"
#include "diagnose/judge.h"
#include "faults/fault.h"

namespace servodx {

Blame blame_of(const Diagnosis& d) {
  switch (d.verdict) {
    case VerdictKind::healthy:
      return Blame::none;
    case VerdictKind::fault:
      return d.fault && d.fault->told_by ? Blame::surroundings : Blame::component;
    case VerdictKind::unknown:
      return d.beyond && d.beyond->taken ? Blame::physics : Blame::test;
  }
  return Blame::none;
}

}  // namespace servodx
