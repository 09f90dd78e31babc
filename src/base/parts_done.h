// How far a piece of work is whose parts go on side by side: what its parts tell, as one.
#pragma once
#include <cstddef>
#include <mutex>
#include <numeric>
#include <string_view>
#include <vector>

#include "servodx/watch.h"

namespace servodx {

class PartsDone {
 public:
  // `watch` is told, and outlives this; `work`: the name of the whole. All parts are taken to be alike long.
  PartsDone(const Watch& watch, std::string_view work, std::size_t parts)
      : watch_(watch), work_(work), done_(parts, 0.0), runs_(parts, 0) {}

  // Of a part; from any thread.
  void tell(std::size_t part, double done, long simulations) {
    const std::lock_guard lock(mutex_);
    done_[part] = done, runs_[part] = simulations;
    watch_.tell(work_, std::accumulate(done_.begin(), done_.end(), 0.0) / static_cast<double>(done_.size()),
                std::accumulate(runs_.begin(), runs_.end(), 0L));
  }

  // What a part is watched by.
  Watch of(std::size_t part) {
    Watch out = watch_;
    if (out.progress) out.progress = [this, part](const WorkDone& w) { tell(part, w.part, w.simulations); };
    return out;
  }

 private:
  const Watch& watch_;
  std::string_view work_;
  std::mutex mutex_;
  std::vector<double> done_;  // of each part
  std::vector<long> runs_;
};

}  // namespace servodx
