#include "diagnose/test_change.h"

namespace servodx {

TestChange change_of(const TwoFindings& f) {
  if (f.last.healthy && f.now.healthy) return TestChange::alike;
  if (f.now.healthy) return TestChange::mended;
  if (f.last.healthy) return TestChange::failed;
  if (!f.same) return TestChange::another;
  if (!f.last.size || !f.now.size) return TestChange::alike;
  const bool above = f.now.size->lower > f.last.size->upper, below = f.now.size->upper < f.last.size->lower;
  if (!above && !below) return TestChange::alike;  // of an end that is not known, too
  return above == f.worse_upwards ? TestChange::grown : TestChange::lessened;
}

}  // namespace servodx
