#include "simulate/side_by_side.h"

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <thread>
#include <vector>

namespace servodx {

void side_by_side(int pieces, int threads, const std::function<void(int piece, int threads_of_it)>& work) {
  const int all = threads > 0 ? threads : omp_get_max_threads();
  const int at_a_time = std::min(all, pieces);
  if (at_a_time <= 1) {
    for (int piece = 0; piece < pieces; ++piece) work(piece, all);
    return;
  }
  std::vector<std::exception_ptr> failures(static_cast<std::size_t>(pieces));
  std::atomic<int> next = 0;
  std::atomic<bool> failed = false;
  const auto take = [&] {
    omp_set_num_threads(all / at_a_time);  // of what a piece does by itself
    while (!failed) {
      const int piece = next++;  // one that is taken is done, so that all before a failure are
      if (piece >= pieces) return;
      try {
        work(piece, all / at_a_time);
      } catch (...) {
        failures[static_cast<std::size_t>(piece)] = std::current_exception();
        failed = true;
      }
    }
  };
  {
    std::vector<std::jthread> workers;
    for (int k = 0; k < at_a_time; ++k) workers.emplace_back(take);
  }
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

}  // namespace servodx
