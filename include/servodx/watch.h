// How a long call is watched and ended: both are the caller's. The library prints nothing.
#pragma once
#include <functional>
#include <string_view>

namespace servodx {

struct WorkDone {
  std::string_view work;  // "tune", "baseline", ...
  double part = 0;        // of the work, 0 to 1
  long simulations = 0;   // so far
};

struct Watch {
  std::function<void(const WorkDone&)> progress = {};  // may be called from any thread
  // Asked often and from any thread; true ends the call soon, with the best so far. It does not turn false again.
  std::function<bool()> stop = {};

  bool stopped() const { return stop && stop(); }
  void tell(std::string_view work, double part, long simulations) const {
    if (progress) progress({work, part, simulations});
  }
};

}  // namespace servodx
