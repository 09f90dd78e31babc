// What has become of a valve from one test to a later one, by what each of them found.
//
// Two 95 % intervals that do not touch differ with over 99 %; a size without an interval is as it was.
#pragma once
#include <optional>

namespace servodx {

// alike: the same finding, and sizes whose intervals touch. failed: healthy before. mended: healthy now. grown,
// lessened: the same fault. another: another fault, or an unknown state in place of one.
enum class TestChange { alike, failed, mended, grown, lessened, another };

struct TestFinding {
  struct Size {
    double lower = 0, upper = 0;  // [the fault's unit] 95 %; NaN: not known
  };
  bool healthy = false;
  std::optional<Size> size = {};  // of the fault; none without one
};

struct TwoFindings {
  TestFinding last, now;
  bool same = true;           // the fault, or the verdict where none is named
  bool worse_upwards = true;  // of that fault's sizes
};

TestChange change_of(const TwoFindings& findings);

}  // namespace servodx
