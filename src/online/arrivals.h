// Samples in the order in which they come, made into parts in the order of their time.
//
// A sample that comes late is put in its place while its part is not yet full; later than that it is counted and left
// out. A repeated time is counted and left out: the first is kept. What never comes is a gap.
#pragma once
#include <vector>

#include "online/constants.h"
#include "signals/sample.h"

namespace servodx {

struct ArrivalCounts {
  long taken = 0, late = 0, repeated = 0;
};

class Arrivals {
 public:
  // True once a part is full: take it before the next sample.
  bool add(const Sample& sample);
  std::vector<Sample> take();  // what is there, full or not
  bool empty() const { return part_.empty(); }
  long waiting() const { return static_cast<long>(part_.size()); }                  // samples
  double newest() const { return part_.empty() ? last_taken : part_.back().time; }  // [s]

  ArrivalCounts counts;
  double last_taken = -1e300;  // [s] time of the last sample that was given out

 private:
  std::vector<Sample> part_;
  long late_in_a_row_ = 0;
};

}  // namespace servodx
