// How a long call is watched, ended and gone on with: all are the caller's. The library prints nothing.
#pragma once
#include <functional>
#include <memory>
#include <string_view>

namespace servodx {

class Checkpoint;  // servodx/checkpoint.h

struct WorkDone {
  std::string_view work;  // "tune", "baseline", ...
  double part = 0;        // of the work, 0 to 1
  long simulations = 0;   // so far
};

struct Watch {
  std::function<void(const WorkDone&)> progress = {};  // may be called from any thread
  // Asked often and from any thread; true ends the call soon, with the best so far. It does not turn false again.
  std::function<bool()> stop = {};
  // Stages that are finished are kept there, and those that it holds are not made again. Null: none.
  std::shared_ptr<Checkpoint> checkpoint = {};

  bool stopped() const { return stop && stop(); }
  void tell(std::string_view work, double part, long simulations) const {
    if (progress) progress({work, part, simulations});
  }
};

}  // namespace servodx
