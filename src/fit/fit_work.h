// What a fit has cost.
#pragma once
#include <tuple>

namespace servodx {

struct FitWork {
  long simulations = 0, failed = 0;  // runs; of these, those that left the finite
  void add(const FitWork& other) { simulations += other.simulations, failed += other.failed; }
};
inline auto fields(FitWork& w) {
  auto& [simulations, failed] = w;
  return std::tie(simulations, failed);
}

}  // namespace servodx
