// How fast work goes now, from its last stretch: time left by the mean of a whole run is wrong by multiples where its
// steps grow or shrink.
//
// The stretch is the last tenth of the time so far, 10 s at least. Where nothing was done in it, it goes back to the
// last that was, so that a rate falls while work stands still. No clock: times are the caller's.
#pragma once
#include <algorithm>
#include <cstddef>
#include <deque>
#include <optional>

namespace servodx {

class RecentRate {
 public:
  // `done`: of anything, at `elapsed` [s]. Neither falls. What is there at the first call took no time that is known.
  void add(double elapsed, double done) {
    now_ = {elapsed, done};
    if (points_.empty() || done > points_.back().done) points_.push_back(now_);
    const double from = elapsed - std::max(least_stretch, recent * elapsed);
    while (points_.size() > 2 && points_[1].elapsed <= from && points_[1].done < done) points_.pop_front();
  }
  // [1/s] Empty until something was done over a time that can be believed.
  std::optional<double> per_second() const {
    if (points_.empty()) return {};
    const double time = now_.elapsed - points_.front().elapsed, done = now_.done - points_.front().done;
    if (time < least_time || done <= 0) return {};
    return done / time;
  }

 private:
  static constexpr double recent = 0.1;        // of the time so far
  static constexpr double least_stretch = 10;  // [s]
  static constexpr double least_time = 2;      // [s]
  struct Point {
    double elapsed = 0, done = 0;
  };
  std::deque<Point> points_;  // each where `done` rose
  Point now_;
};

}  // namespace servodx
