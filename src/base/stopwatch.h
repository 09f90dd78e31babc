// Time by the clock on the wall, for what is told and never for what is decided.
#pragma once
#include <chrono>
#include <utility>

namespace servodx {

class Stopwatch {
 public:
  // [s] since the last lap, or since it was made.
  double lap() {
    const Clock::time_point now = Clock::now();
    return std::chrono::duration<double>(now - std::exchange(begun_, now)).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point begun_ = Clock::now();
};

}  // namespace servodx
