// The run of one candidate over a log that comes in parts, and what it remembers from one to the next.
#pragma once
#include <string>
#include <string_view>

namespace servodx {

// Made at the first sample of a scenario, by a kernel (kernels.h). What it was made with must live as long and is
// changed by the caller from part to part: the scenario's series, and the trajectory's, as long as they.
class RunInParts {
 public:
  virtual ~RunInParts() = default;
  // To the scenario's last sample; its first is the one that the part before ended with. False once it has diverged.
  virtual bool go_on() = 0;
  // [m] the rod is put elsewhere.
  virtual void shift_rod(double by) = 0;
  // What it remembers, as bytes that mean something to a run of the same kernel and candidate alone.
  virtual std::string memory() = 0;
  // False, and nothing changed, where the bytes are not as many.
  virtual bool recall(std::string_view bytes) = 0;
};

}  // namespace servodx
